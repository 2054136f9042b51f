#include "nodes/media/output_file.h"

#include <algorithm>
#include <stdexcept>

namespace talkgraph {
namespace fs = std::filesystem;

OutputFile::OutputFile(const Context& context, const std::string& folder, const std::string& prefix,
                       const std::string& suffix, const std::string& ending, const std::string& otherwise) {
  std::string item = context.item.empty() && prefix.empty() && suffix.empty() ? otherwise : context.item;
  std::replace(item.begin(), item.end(), '/', '_');
  stem_ = prefix + item + suffix;
  path_ = (fs::path(folder) / (stem_ + ending)).generic_string();
  file_ = context.folder / path_;
  part_ = file_;
  part_ += ".part";
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  if (error)
    throw std::runtime_error(file_.parent_path().string() + ": this folder cannot be made: " + error.message());
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(part_, ignored);
}

Artifact OutputFile::finish() {
  std::error_code error;
  fs::rename(part_, file_, error);
  if (error) throw std::runtime_error(file_.string() + ": cannot be written: " + error.message());
  return {path_, stem_};
}

}  // namespace talkgraph
