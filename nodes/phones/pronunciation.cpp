#include "nodes/phones/pronunciation.h"

#include <cctype>

#include "nodes/phones/decoder_pool.h"
#include "nodes/phones/pocketsphinx.h"
#include "nodes/voice/voice.h"

namespace talkgraph {

std::vector<std::string> phones_of_words(const std::vector<std::string>& words) {
  const auto dictionary = decoder_pool<SphinxAligner>().take();
  std::vector<std::string> out;
  for (const auto& word : words)
    for (auto phone : dictionary->knows(word) ? dictionary->pronunciation(word) : pronounce(word)) {
      for (char& c : phone) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      out.push_back(std::move(phone));
    }
  return out;
}

}  // namespace talkgraph
