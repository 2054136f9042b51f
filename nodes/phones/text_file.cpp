#include "nodes/phones/text_file.h"

#include <fstream>
#include <stdexcept>

namespace talkgraph {

Artifact write_text(const std::filesystem::path& run_folder, const std::string& path, const std::string& text,
                    std::string title) {
  const std::filesystem::path file = run_folder / path;
  std::filesystem::path part = file;
  part += ".part";
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::ofstream out(part, std::ios::binary);
  out << text;
  out.close();
  if (out) std::filesystem::rename(part, file, error);
  if (!out || error)
    throw std::runtime_error("cannot write " + file.string() + ": is the folder writable, is there room on the disk?");
  return {path, std::move(title)};
}

}  // namespace talkgraph
