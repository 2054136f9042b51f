#include "nodes/corpus/ids.h"

#include <fmt/format.h>

#include <algorithm>

namespace talkgraph {
namespace {

constexpr std::size_t most = 100, most_of_name = 90;  ///< bytes

bool is_forbidden(unsigned char c) { return c < ' ' || c == 0x7f || c == '/'; }

/// At most `size` bytes, without a part of a character at the end.
std::string cut(std::string text, std::size_t size) {
  if (text.size() <= size) return text;
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
  while (size > 0 && continues(text[size])) --size;
  return text.substr(0, size);
}

}  // namespace

bool is_id(const std::string& text) {
  return !text.empty() && text.size() <= most && text[0] != '.' && std::none_of(text.begin(), text.end(), is_forbidden);
}

std::string unique_id(const std::string& name, std::set<std::string>& taken) {
  std::string plain = name;
  std::replace_if(plain.begin(), plain.end(), is_forbidden, '-');
  if (plain.empty() || plain[0] == '.') plain = "-" + plain;
  if (plain.size() > most) plain = cut(plain, most_of_name);
  std::string id = plain;
  for (int n = 2; !taken.insert(id).second; ++n) id = fmt::format("{}-{}", cut(plain, most_of_name), n);
  return id;
}

}  // namespace talkgraph
