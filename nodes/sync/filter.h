#pragma once

#include <Eigen/Core>
#include <functional>

#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// sin(πx) / (πx)
double sinc(double x);

/// Kaiser window from -1 to 1, not normalised.
double kaiser(double x, double beta);

/// A track on the frames of the video, each one a weighted sum of the 2 · reach input frames around its centre.
/// `weights(phase)` gives them for a centre that lies `phase` (0..1) behind the reach-th; it is asked once a phase, of
/// which there are as many as the ratio of the rates has parts, so that nothing drifts. Ends are repeated. Throws
/// std::runtime_error as `check_finite` and `video_frames` do.
Track filter_to_video(const Track& track, const Audio* audio, const Rational& rate, Eigen::Index reach,
                      const std::function<Eigen::RowVectorXd(double phase)>& weights);

}  // namespace talkgraph
