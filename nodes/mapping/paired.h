#pragma once

#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The utterances that all streams have, by key, each on its common beginning; their lengths differ by at most two
/// frames. Throws std::runtime_error, naming the utterance, if they differ by more, and if no utterance is left.

/// Audio and visual frames side by side, lost where the face is.
struct SideBySide {
  Collected<Track> tracks;  ///< T × (D_Y + D_Z)
  Eigen::Index audio = 0;   ///< D_Y
};
SideBySide side_by_side(const Collected<Track>& audio, const Collected<Track>& visual);

/// Tracks with a label a frame.
struct Labelled {
  Collected<Track> tracks;
  std::vector<std::string> labels;  ///< of all frames that are not lost, one track after the other
};
Labelled labelled(const Collected<Track>& tracks, const Collected<FrameLabels>& labels);

}  // namespace talkgraph
