#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace talkgraph {

/// 128 bits that name a value: equal keys, equal values. All zero is no key.
struct Key {
  std::uint64_t high = 0, low = 0;

  auto operator<=>(const Key&) const = default;
  explicit operator bool() const { return high || low; }
  /// 32 hexadecimal digits.
  std::string str() const;
};

/// Makes one key of several parts; their order counts, and no two lists of parts run together.
class KeyMaker {
 public:
  KeyMaker();
  ~KeyMaker();
  KeyMaker(const KeyMaker&) = delete;
  KeyMaker& operator=(const KeyMaker&) = delete;

  KeyMaker& add(std::string_view text);
  KeyMaker& add(const Key& key);
  Key key() const;

 private:
  struct State;
  State* state_;
};

/// Of the bytes of a file, or of the names and bytes of all files below a folder; nothing where there is none.
/// Throws std::runtime_error that names a file that cannot be read.
Key file_key(const std::filesystem::path& path);

}  // namespace talkgraph
