#pragma once

#include <Eigen/Core>
#include <optional>

#include "nodes/latent/objective.h"
#include "nodes/latent/predictive.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

/// Negative log-likelihood of new audio frames and their latent points under a
/// trained SGPDM, as a function of the latent points (T × d, column by column):
/// the predictive density of the audio with its variance, with dynamics also
/// that of every step and the prior of the first point (Eqn 4.78), or that of every
/// point given its time, without them Eqn 4.77 for independent points.
class SequenceObjective : public Objective {
 public:
  /// `audio` is T × D_Y, scaled; it and the model must outlive the objective.
  SequenceObjective(const Sgpdm& model, const Eigen::MatrixXd& audio, bool with_dynamics);
  /// Adds ln p(visual | points), of frames that are seen, too; `visual` is T × D_Z, scaled.
  void see(Eigen::MatrixXd visual);
  /// Adds weight · ln p(visual | first point) under the visual process, which
  /// draws the first frame towards that of the segment before; `visual` is 1 × D_Z, scaled.
  void follow(const Eigen::RowVectorXd& visual, double weight);

  Eigen::Index size() const override { return audio_.rows() * model_.latents.cols(); }
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) override;

 private:
  double dynamics(const Eigen::MatrixXd& x, bool with_gradient);
  double steps(const Eigen::MatrixXd& x, bool with_gradient);
  double at_times(const Eigen::MatrixXd& x, bool with_gradient);
  double visual(const Eigen::MatrixXd& frames, double weight, bool with_gradient);

  const Sgpdm& model_;
  const Eigen::MatrixXd& audio_;
  bool with_dynamics_;
  Eigen::MatrixXd before_, seen_, times_, times_gradient_;
  double follow_weight_ = 0;
  Predictive f_, g_, h_;
  Eigen::MatrixXd x_, x_gradient_, audio_gradient_, visual_gradient_, step_, step_gradient_;
};

}  // namespace talkgraph
