#include "graph/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace talkgraph {
namespace fs = std::filesystem;

OutputFile::OutputFile(fs::path file) : file_(std::move(file)) {
  part_ =
      file_.parent_path() / fmt::format("{}.part-{}{}", file_.stem().string(), getpid(), file_.extension().string());
  if (file_.parent_path().empty()) return;
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  if (error)
    throw std::runtime_error(
        fmt::format("{}: this folder cannot be made: {}", file_.parent_path().string(), error.message()));
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void OutputFile::finish() {
  std::error_code error;
  fs::rename(part_, file_, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file_.string(), error.message()));
}

void put_files(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    if (!entry.is_regular_file()) continue;
    OutputFile file(to / fs::relative(entry.path(), from));
    fs::copy_file(entry.path(), file.part(), fs::copy_options::overwrite_existing);
    file.finish();
  }
}

void write_file(const fs::path& file, std::string_view text) {
  OutputFile whole(file);
  errno = 0;
  std::ofstream out(whole.part(), std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  whole.finish();
}

}  // namespace talkgraph
