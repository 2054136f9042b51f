#pragma once

#include "graph/rational.h"
#include "nodes/types/audio.h"

namespace talkgraph {

/// Log power of the sound within each video frame, T values.
Eigen::VectorXd sound_envelope(const Audio& audio, const Rational& fps, Eigen::Index frames);

/// Correlation of a movement with the sound's envelope, the movement being
/// moved ahead by -max_lag, ..., max_lag frames: 2 max_lag + 1 values. Above 0
/// the movement is late. Frames whose movement is NaN do not count. NaN where fewer than three frames overlap or
/// either does not vary.
Eigen::VectorXd lag_correlations(const Eigen::VectorXd& movement, const Eigen::VectorXd& envelope, int max_lag);

}  // namespace talkgraph
