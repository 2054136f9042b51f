#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace talkgraph::study {

struct ByteRange {
  std::size_t first = 0;
  std::size_t length = 0;  ///< 0: there is nothing of it
};

/// What a header Range asks of so many bytes: "bytes=2-5", "bytes=7-", "bytes=-3". Nothing where all is to be sent: no
/// header, several ranges, or what cannot be read (RFC 9110, 14.2).
std::optional<ByteRange> range_of(const std::string& header, std::size_t size);

}  // namespace talkgraph::study
