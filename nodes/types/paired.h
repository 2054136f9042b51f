#pragma once

#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The frames that two streams of one utterance have in common at their beginning. Throws std::runtime_error, naming
/// it, if they differ by more than two.
Eigen::Index common_frames(const std::string& utterance, Eigen::Index a, const char* of_a, Eigen::Index b,
                           const char* of_b);

/// The first frames of a track.
Track beginning(const Track& track, Eigen::Index frames);

/// Audio and visual frames side by side, lost where the face is, of the utterances that both streams have. Throws
/// std::runtime_error as common_frames(), and if there is none.
struct JoinedStreams {
  Collected<Track> tracks;  ///< T × (D_Y + D_Z)
  Eigen::Index audio = 0;   ///< D_Y
};
JoinedStreams side_by_side(const Collected<Track>& audio, const Collected<Track>& visual);

/// Tracks with a label a frame, likewise.
struct Labelled {
  Collected<Track> tracks;
  std::vector<std::string> labels;  ///< of all frames that are not lost, one track after the other
};
Labelled labelled(const Collected<Track>& tracks, const Collected<FrameLabels>& labels);

}  // namespace talkgraph
