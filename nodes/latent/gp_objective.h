#pragma once

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/maximand.h"

namespace talkgraph {

/// Log-likelihood of Gaussian process regression as a function of inducing points (k × d, column by column;
/// where the likelihood has them and they are not fixed) and log kernel parameters.
class GpObjective : public Maximand {
 public:
  /// Inputs N × d, outputs N × D and the likelihood must outlive the objective.
  GpObjective(GpLikelihood& likelihood, Kernel kernel, const Eigen::MatrixXd& x, Eigen::MatrixXd inducing,
              bool fix_inducing, const Eigen::MatrixXd& y);

  Eigen::VectorXd start() const;
  Eigen::Index size() const override;
  void hold_noise(bool hold) override { noise_held_ = hold; }
  std::string name(Eigen::Index parameter) const override;
  /// Throws FactorisationError.
  GaussianProcess posterior(const Eigen::VectorXd& parameters);

 protected:
  double compute(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) override;

 private:
  void set(const Eigen::VectorXd& parameters);

  GpLikelihood& likelihood_;
  Kernel kernel_;
  const Eigen::MatrixXd &x_, &y_;
  Eigen::MatrixXd inducing_;
  Eigen::Index moving_;  // numbers of inducing points that are parameters
  GpGradient g_;
  bool noise_held_ = false;
};

}  // namespace talkgraph
