#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Scores of one sequence on the frames that `speech` marks (all if it is not
/// given), spec §6:
///   amse        mean squared error over frames and dimensions (Eqn 6.5)
///   amse_share  amse / mean square of the truth: 1 is what predicting the mean (zero) gives
///   acc         correlation averaged over dimensions (Eqn 6.9 with standard deviations);
///               0 for a dimension that does not vary
///   l1, l2, linf  Eqns 6.6 to 6.8, absolute values
///   range       standard deviation of the first dimension, prediction / truth
/// Nothing is given for a sequence without a marked frame. Throws
/// std::runtime_error if dimensions differ, or lengths by more than two frames.
struct Score {
  std::optional<Scores> operator()(const Track& truth, const Track& predicted, const Mask* speech) const;
};
void describe(Description<Score>& d);

}  // namespace talkgraph
