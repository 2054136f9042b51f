#pragma once

#include <string>
#include <vector>

namespace talkgraph {

/// The CMU phones of words (lower case) in their order, as alignment would look for them: the dictionary's first
/// pronunciation, or espeak-ng's of a word that it does not hold. Words without a pronunciation give none.
std::vector<std::string> phones_of_words(const std::vector<std::string>& words);

}  // namespace talkgraph
