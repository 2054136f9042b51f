#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The frames that count, of truth and prediction side by side.
struct ScoredFrames {
  Eigen::MatrixXd truth, predicted;  ///< N × D
};
/// Of the common beginning, those that `speech` marks (all if it is not given) and the truth has not lost. Throws
/// std::runtime_error if dimensions differ, lengths differ by more than two frames, or a value is not finite.
ScoredFrames scored_frames(const Track& truth, const Track& predicted, const Mask* speech);

/// Pearson's, of at least one value; 0 where either does not vary.
double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b);
/// Range of motion: standard deviation of the prediction / of the truth; NaN if the truth does not vary.
double range_of_motion(const Eigen::VectorXd& truth, const Eigen::VectorXd& predicted);

/// Scores of one sequence on the frames that `speech` marks (all if it is not
/// given) and the truth has not lost, docs/method.md §6. Tracks are normalised: a truth of zero is the mean face.
///   amse        mean squared error over frames and dimensions (Eqn 6.5)
///   amse_share  amse / mean square of the truth: 1 is what predicting the mean (zero) gives
///   acc         correlation averaged over dimensions (Eqn 6.9 with standard deviations);
///               0 for a dimension that does not vary
///   l1, l2, linf  Eqns 6.6 to 6.8, absolute values
///   range       range of motion: standard deviation of the first dimension, prediction / truth
/// amse_share is NaN if the truth is zero all over, range if its first
/// dimension does not vary; evaluate.summary leaves NaN out. Nothing is given for
/// a sequence without a marked frame. Throws as scored_frames does.
struct Score {
  std::optional<Scores> operator()(const Track& truth, const Track& predicted, const Mask* speech) const;
};
void describe(Description<Score>& d);

}  // namespace talkgraph
