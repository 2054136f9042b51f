#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace talkgraph {

/// A file that carries a temporary name beside its own until it is whole: who
/// looks for the file finds all of it or the one before it. Makes its folder.
/// Throws std::runtime_error that names the file or folder and the cause.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path file);
  /// Removes what was not finished.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write. It keeps the ending, by which libraries tell formats.
  std::string part() const { return part_.string(); }
  /// Gives the file its name.
  void finish();

 private:
  std::filesystem::path file_, part_;
};

/// Removes what killed processes left unfinished in a folder and below it: parts of files, and folders called
/// ".desk-<process>-...".
void sweep_parts(const std::filesystem::path& folder);

/// Copies all files below a folder to another, each whole or not at all.
void put_files(const std::filesystem::path& from, const std::filesystem::path& to);

/// Writes a text file whole or not at all.
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace talkgraph
