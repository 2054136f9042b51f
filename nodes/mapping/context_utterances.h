#pragma once

#include <string>
#include <vector>

#include "graph/value.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// An utterance of which soft contexts learn; the tracks belong to somebody else.
struct ContextUtterance {
  std::string key;
  const Track* audio;
  const PhoneTrack* phones;
  const Track* visual;
  Eigen::Index frames;  ///< that both tracks have
};

/// Those that have sound, phones and face, in the order of the sound. Throws std::runtime_error if none has, on values
/// that are not finite, and where dimensions differ or lengths do by more than two frames.
std::vector<ContextUtterance> context_utterances(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                                                 const Collected<Track>& visual);

/// Whether each frame is in speech or at most `margin` frames from it.
std::vector<bool> near_speech(const ContextUtterance& utterance, int margin);

}  // namespace talkgraph
