#pragma once

#include <cstddef>
#include <string_view>

namespace talkgraph {

/// How many sentences the built-in speaker knows.
std::size_t speaker_sentence_count();

/// One of them, about 2 to 4 seconds of speech.
std::string_view speaker_sentence(std::size_t index);

}  // namespace talkgraph
