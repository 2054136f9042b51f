#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Marks the frames of speech: 1 where the frame's centre lies in a phone other
/// than "sil" and "breath", 0 elsewhere and beyond the last phone.
struct SpeechMask {
  double pauses = 0;  ///< silences between speech shorter than this count as speech, seconds
  Mask operator()(const PhoneTrack& phones, const Track& like) const;
};
void describe(Description<SpeechMask>& d);

/// The same from words: "sil" and "sp" are pauses.
struct WordMask {
  double pauses = 0;
  Mask operator()(const WordTrack& words, const Track& like) const;
};
void describe(Description<WordMask>& d);

}  // namespace talkgraph
