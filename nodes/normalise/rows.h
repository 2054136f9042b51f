#pragma once

#include "nodes/types/track.h"

namespace talkgraph {

/// The frames of all tracks that are not lost, N × D. Throws std::runtime_error,
/// naming the track, on no tracks, dimensions that differ and values that are
/// not finite.
Eigen::MatrixXd measured_rows(const Collected<Track>& tracks);

}  // namespace talkgraph
