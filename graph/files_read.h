#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace talkgraph {

/// A file as it was when it was read: a later change of it, by whatever means, shows.
struct FileStamp {
  std::filesystem::path path;
  std::uint64_t file = 0, bytes = 0;
  std::int64_t changed = 0;  ///< nanoseconds

  static FileStamp of(const std::filesystem::path& path);
  bool operator==(const FileStamp&) const = default;
};

/// Gathers the stamps of the files that file_key reads on this thread while it lives.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;

  std::vector<FileStamp> stamps;

 private:
  FilesRead* outer_;
};

}  // namespace talkgraph
