#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "nodes/types/track.h"

namespace talkgraph {

/// Frames of sequences, one after the other, N × D.
struct Sequences {
  Eigen::MatrixXd frames;
  std::vector<std::int64_t> lengths;  ///< none is 0; they sum to N
};

/// Every run of measured frames is a sequence: lost frames are left out, and no step leads over them. Throws
/// std::runtime_error, naming the track, on different dimensions, on values that are not finite, and if there is no
/// measured frame.
Sequences measured_runs(const Collected<Track>& tracks);

/// Every frame that has one after it in its sequence, and that one.
struct Steps {
  Eigen::MatrixXd from, to;
};
Steps steps_of(const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lengths);

/// Frames of two streams, N × D each.
struct PairedFrames {
  Eigen::MatrixXd audio, visual;
};
/// Those that both tracks of a key have measured, tracks being used on their common beginning. Throws
/// std::runtime_error as measured_runs does, and where common_frames does.
PairedFrames paired_frames(const Collected<Track>& audio, const Collected<Track>& visual);

/// Throws std::runtime_error if the track has another dimension, or a value that is not finite; `model` is what has
/// that dimension ("the mixture").
void require_frames_of(const Track& track, Eigen::Index dimension, const char* model);

}  // namespace talkgraph
