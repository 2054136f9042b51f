#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talkgraph {

/// The words of a text as they are said: lower case, without punctuation,
/// split at hyphens, apostrophes inside words kept, numbers, "%", "&" and sums of
/// money spelled out ("1984" as "nineteen eighty four", "3.5" as "three point five",
/// "2nd" as "second", "1990s" as "nineteen nineties", "$3.50" as "three dollars fifty"). Bytes beyond ASCII count as
/// letters.
std::vector<std::string> spoken_words(std::string_view text);

}  // namespace talkgraph
