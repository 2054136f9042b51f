#pragma once

#include <string>
#include <vector>

#include "nodes/types/phones.h"

namespace talkgraph {

/// Words of a text in lower case, without punctuation around them.
std::vector<std::string> split_words(const std::string& text);

/// Times of the words of `text`: the phones that were spoken are aligned with
/// those of each word on its own (least edit distance), since espeak-ng runs
/// words together ("of the") and reads one as several (numbers). Words that
/// were not spoken are left out; silences between words are "sil".
WordTrack find_words(const std::string& text, const PhoneTrack& phones);

}  // namespace talkgraph
