#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What another track says of each dimension of `truth` linearly: 1 − squared
/// error / variance, 0 at least, of ridge regression on the other's values of
/// the same frames. The frames of all clips, one after the other, are cut into
/// `folds` parts, and each is predicted from the rest. Tracks are matched by
/// key; frames that either has lost are left out. Throws std::runtime_error if
/// no clip is in both, dimensions differ between clips, lengths differ by more
/// than two frames, values are not finite, or there are fewer frames than
/// folds or dimensions.
struct Explained {
  int folds = 5;
  double ridge =
      1e-9;  ///< penalty, as a share of the mean variance of the other's dimensions; tells rounding from speech

  /// One row "explained", a column a dimension of `truth`, NaN where it does not vary.
  Table operator()(const Collected<Track>& truth, const Collected<Track>& by) const;
};
void describe(Description<Explained>& d);

/// The frames that both sides of all clips have, N rows each.
struct PairedRows {
  Eigen::MatrixXd truth, by;
};
PairedRows paired_rows(const Collected<Track>& truth, const Collected<Track>& by);

/// The same of rows, an entry a column of `truth`.
Eigen::RowVectorXd explained_share(const Eigen::MatrixXd& truth, const Eigen::MatrixXd& by, int folds, double ridge);

}  // namespace talkgraph
