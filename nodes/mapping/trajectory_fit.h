#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace talkgraph {

/// Linear functions of a trajectory's frames, one a row (R × T), each of a few neighbouring frames.
using TrajectoryRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The frames themselves, T rows, then their slopes (y_{t+1} − y_{t−1}) / 2, T rows; the first and last frame are
/// repeated beyond the ends.
TrajectoryRows frames_and_slopes(Eigen::Index frames);
/// The same, then their curvatures y_{t+1} − 2 y_t + y_{t−1}, T rows (Tokuda et al. 2000).
TrajectoryRows frames_slopes_and_curvatures(Eigen::Index frames);
/// The frames themselves, T rows, then their differences of an order ≥ 1, T − order rows or none.
TrajectoryRows frames_and_differences(Eigen::Index frames, Eigen::Index order);

/// What `blocks` of T rows tell of trajectories of T frames, T × D: each beside the one before it, T × blocks · D.
Eigen::MatrixXd blocks_beside(const TrajectoryRows& rows, Eigen::Index blocks, const Eigen::MatrixXd& frames);
/// The same of sequences that lie one after the other, whose rows `rows_of` gives.
Eigen::MatrixXd blocks_beside(TrajectoryRows (*rows_of)(Eigen::Index), Eigen::Index blocks,
                              const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lengths);

/// The trajectory y that minimises Σ_r p_r (e_r − (W y)_r)², given what is expected of rows W and how precisely:
/// y = (WᵀPW)⁻¹ WᵀPe, in time linear in T.
class TrajectoryFit {
 public:
  /// Precisions p and targets e have R entries; the rows must outlive the fit. Throws FactorisationError if they do not
  /// determine the trajectory.
  TrajectoryFit(const TrajectoryRows& rows, Eigen::VectorXd precisions, Eigen::VectorXd targets);

  const Eigen::VectorXd& trajectory() const { return trajectory_; }

  struct Gradient {
    Eigen::VectorXd precisions, targets;
  };
  /// Of a cost whose derivatives by the trajectory's frames are given.
  Gradient gradient(Eigen::VectorXd by_frames) const;

 private:
  void solve(Eigen::VectorXd& b) const;

  const TrajectoryRows& rows_;
  Eigen::VectorXd precisions_, targets_, trajectory_;
  Eigen::MatrixXd band_;  ///< lower band of the Cholesky factor of WᵀPW, (bandwidth + 1) × T
};

}  // namespace talkgraph
