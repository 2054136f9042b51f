#pragma once

#include "graph/context.h"
#include "nodes/latent/objective.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/trajectory_fit.h"

namespace talkgraph {

/// Independent Gaussians of K states over what the rows of trajectories tell of a frame: of each of `kinds` blocks of
/// T rows (frames; their slopes), in D dimensions.
struct StateGaussians {
  Eigen::MatrixXd means;      ///< K × kinds · D
  Eigen::MatrixXd variances;  ///< likewise
  Eigen::Index kinds = 1;
  double smoothness = 0;  ///< precision with which all further rows are nought

  Eigen::Index dimensions() const { return means.cols() / kinds; }
};

/// One sequence as states see it.
struct StatePath {
  TrajectoryRows rows;               ///< kinds · T, and further ones
  std::vector<Eigen::Index> states;  ///< of each frame
  Eigen::VectorXd weights;           ///< of each frame's precisions
  Eigen::MatrixXd shifts;            ///< what is added to the states' means, T × kinds · D; or empty
};

/// The trajectory that the Gaussians make likeliest, T × D.
Eigen::MatrixXd trajectory(const StateGaussians& states, const StatePath& path);

/// Half the squared error of trajectories, summed over dimensions, its mean over frames, as a function of means and
/// logarithms of variances.
class TrajectoryError : public Objective {
 public:
  /// The paths and the frames that they ought to give, one after the other, must outlive the objective.
  TrajectoryError(StateGaussians states, const std::vector<StatePath>& paths, const Eigen::MatrixXd& frames)
      : states_(std::move(states)), paths_(paths), frames_(frames) {}

  Eigen::Index size() const override { return 2 * states_.means.size(); }
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) override;

  Eigen::VectorXd start() const;
  StateGaussians states(const Eigen::VectorXd& parameters) const;

 private:
  StateGaussians states_;
  const std::vector<StatePath>& paths_;
  const Eigen::MatrixXd& frames_;
};

/// Lowers the error of trajectories by scaled conjugate gradients. Gives the mean squared error of a frame's dimension
/// at the start and after each iteration. `subject` ("40 phones") stands in the log. Throws std::runtime_error where
/// trajectories are not determined to start with.
std::vector<double> lower_error(StateGaussians& states, const std::vector<StatePath>& paths,
                                const Eigen::MatrixXd& frames, int iterations, const std::string& subject,
                                Context& context);

}  // namespace talkgraph
