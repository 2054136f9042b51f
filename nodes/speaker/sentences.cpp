#include "nodes/speaker/sentences.h"

#include <array>

namespace talkgraph {
namespace {

constexpr std::string_view sentences[] = {
#include "nodes/speaker/sentences.inc"
};

}  // namespace

std::size_t speaker_sentence_count() { return std::size(sentences); }

std::string_view speaker_sentence(std::size_t index) { return sentences[index]; }

}  // namespace talkgraph
