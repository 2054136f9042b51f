#include "study/range.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace talkgraph::study {
namespace {

/// Nothing where it is no number, or one beyond all sizes.
std::optional<std::size_t> number(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), value);
  if (text.empty() || error != std::errc() || end != text.end()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<ByteRange> range_of(const std::string& header, std::size_t size) {
  constexpr std::string_view unit = "bytes=";
  const auto dash = header.find('-');
  if (!header.starts_with(unit) || dash == std::string::npos) return std::nullopt;
  const std::string_view text(header);
  const auto from = text.substr(unit.size(), dash - unit.size()), to = text.substr(dash + 1);
  const auto first = number(from), last = number(to);
  if (from.empty() && last) {
    const auto length = std::min(*last, size);
    return ByteRange{size - length, length};
  }
  if (!first || (!to.empty() && (!last || *last < *first))) return std::nullopt;
  if (*first >= size) return ByteRange{};
  return ByteRange{*first, std::min(last.value_or(size), size - 1) - *first + 1};
}

}  // namespace talkgraph::study
