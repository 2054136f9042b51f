#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// Frames less their mean, and how far each dimension spreads about it.
struct CentredFrames {
  Eigen::MatrixXd values;              ///< N × D, zero where a value is missing
  Eigen::RowVectorXd mean, deviation;  ///< 1 × D, of what is there

  bool varies() const { return (deviation.array() > 0).any(); }
};
/// Of N × D frames; NaN marks a missing value. A dimension whose values differ by at most 1e-13 of the largest among
/// them varies by rounding only: its deviation and its centred values are zero.
CentredFrames centred(const Eigen::MatrixXd& frames);

}  // namespace talkgraph
