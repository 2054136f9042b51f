#include "nodes/mapping/context_utterances.h"

#include <stdexcept>

#include "nodes/types/paired.h"
#include "nodes/types/visemes.h"

namespace talkgraph {

std::vector<ContextUtterance> context_utterances(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                                                 const Collected<Track>& visual) {
  std::vector<ContextUtterance> utterances;
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const auto& key = audio.key(i);
    const Track *heard = &audio[i], *seen = visual.find(key);
    const PhoneTrack* said = phones.find(key);
    if (!said || !seen) continue;
    const Eigen::Index frames = common_frames(key, heard->frames(), "audio frames", seen->frames(), "visual frames");
    if (!heard->values.allFinite() || !seen->values.allFinite())
      throw std::runtime_error(key + ": NaN or infinite values");
    utterances.push_back({key, heard, said, seen, frames});
    if (heard->dimension() != utterances[0].audio->dimension() ||
        seen->dimension() != utterances[0].visual->dimension())
      throw std::runtime_error(key + ": other dimensions than the tracks before");
  }
  if (utterances.empty())
    throw std::runtime_error("no training utterance has sound, phones and face: is the selection empty?");
  return utterances;
}

std::vector<bool> near_speech(const ContextUtterance& utterance, int margin) {
  const Track& track = *utterance.audio;
  const double reach = (0.5 + margin) / track.rate.value();
  std::vector<bool> near(static_cast<std::size_t>(utterance.frames));
  for (const auto& phone : utterance.phones->phones) {
    if (is_pause(phone.label)) continue;
    for (Eigen::Index t = 0; t < utterance.frames; ++t)
      if (track.time(t) > phone.start - reach && track.time(t) < phone.end + reach)
        near[static_cast<std::size_t>(t)] = true;
  }
  return near;
}

}  // namespace talkgraph
