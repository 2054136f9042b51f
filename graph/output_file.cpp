#include "graph/output_file.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <vector>

namespace talkgraph {
namespace fs = std::filesystem;

namespace {

/// "part-<process>-<number>": of its own also among the threads of a process.
std::string part_name() {
  static std::atomic<unsigned> number{0};
  return fmt::format("part-{}-{}", getpid(), ++number);
}

bool is_running(long process) { return kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH; }

}  // namespace

OutputFile::OutputFile(fs::path file) : file_(std::move(file)) {
  part_ = file_.parent_path() / fmt::format("{}.{}{}", file_.stem().string(), part_name(), file_.extension().string());
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

void sweep_parts(const fs::path& folder) {
  static const std::regex part(R"(.*\.part-(\d+)-\d+(\.[^.]*)?)"), desk(R"(\.desk-(\d+)-.*)");
  std::vector<fs::path> left;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, match, entry.is_directory() ? desk : part) && !is_running(std::stol(match[1])))
      left.push_back(entry.path());
  }
  for (const auto& path : left) fs::remove_all(path);
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
