#include "graph/key.h"

#include <fmt/format.h>
#include <sys/stat.h>
// Gives the state's members, so that it can be made in place.
#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "graph/files_read.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

thread_local FilesRead* files_read = nullptr;

Key key_of_file(const fs::path& path) {
  if (files_read) files_read->stamps.push_back(FileStamp::of(path));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": is missing or cannot be read");
  KeyMaker maker;
  std::vector<char> bytes(1 << 20);
  while (file.read(bytes.data(), std::ssize(bytes)) || file.gcount() > 0)
    maker.add({bytes.data(), static_cast<std::size_t>(file.gcount())});
  if (file.bad()) throw std::runtime_error(path.string() + ": cannot be read to its end");
  return maker.key();
}

}  // namespace

std::string Key::str() const { return fmt::format("{:016x}{:016x}", high, low); }

struct KeyMaker::State {
  alignas(64) XXH3_state_t xxh;
};

KeyMaker::KeyMaker() : state_(new State) { XXH3_128bits_reset(&state_->xxh); }
KeyMaker::~KeyMaker() { delete state_; }

KeyMaker& KeyMaker::add(std::string_view text) {
  const std::uint64_t size = text.size();
  XXH3_128bits_update(&state_->xxh, &size, sizeof size);
  XXH3_128bits_update(&state_->xxh, text.data(), text.size());
  return *this;
}

KeyMaker& KeyMaker::add(const Key& key) {
  XXH3_128bits_update(&state_->xxh, &key.high, sizeof key.high);
  XXH3_128bits_update(&state_->xxh, &key.low, sizeof key.low);
  return *this;
}

Key KeyMaker::key() const {
  const auto h = XXH3_128bits_digest(&state_->xxh);
  return {h.high64, h.low64};
}

FileStamp FileStamp::of(const fs::path& path) {
  struct stat s {};
  if (stat(path.c_str(), &s) != 0) return {path};
  return {path, s.st_ino, static_cast<std::uint64_t>(s.st_size),
          std::int64_t{s.st_ctim.tv_sec} * 1'000'000'000 + s.st_ctim.tv_nsec};
}

FilesRead::FilesRead() : outer_(std::exchange(files_read, this)) {}
FilesRead::~FilesRead() { files_read = outer_; }

Key file_key(const fs::path& path) {
  if (!fs::exists(path)) return {};
  if (!fs::is_directory(path)) return key_of_file(path);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  KeyMaker maker;
  for (const auto& file : files) maker.add(fs::relative(file, path).string()).add(key_of_file(file));
  return maker.key();
}

}  // namespace talkgraph
