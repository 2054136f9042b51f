#include "nodes/phones/text_file.h"

#include <fstream>
#include <stdexcept>

#include "nodes/media/output_file.h"

namespace talkgraph {

Artifact write_text(const Context& context, const std::string& folder, const std::string& ending,
                    const std::string& otherwise, const std::string& text) {
  OutputFile file(context, folder, "", "", ending, otherwise);
  std::ofstream out(file.part(), std::ios::binary);
  out << text;
  out.close();
  if (!out)
    throw std::runtime_error("cannot write " + file.part() + ": is the folder writable, is there room on the disk?");
  return file.finish();
}

}  // namespace talkgraph
