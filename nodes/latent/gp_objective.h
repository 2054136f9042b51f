#pragma once

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/objective.h"

namespace talkgraph {

/// Negative log-likelihood of Gaussian process regression as a function of inducing points (k × d, column by column;
/// where the likelihood has them and they are not fixed) and log kernel parameters.
class GpObjective : public Objective {
 public:
  /// Inputs N × d, outputs N × D and the likelihood must outlive the objective.
  GpObjective(GpLikelihood& likelihood, Kernel kernel, const Eigen::MatrixXd& x, Eigen::MatrixXd inducing,
              bool fix_inducing, const Eigen::MatrixXd& y);

  Eigen::VectorXd start() const;
  Eigen::Index size() const override;
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) override;
  std::string name(Eigen::Index parameter) const override;
  /// Throws FactorisationError.
  GaussianProcess posterior(const Eigen::VectorXd& parameters);

 private:
  void set(const Eigen::VectorXd& parameters);
  double log_likelihood(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient);

  GpLikelihood& likelihood_;
  Kernel kernel_;
  const Eigen::MatrixXd &x_, &y_;
  Eigen::MatrixXd inducing_;
  Eigen::Index moving_;  // numbers of inducing points that are parameters
  GpGradient g_;
};

}  // namespace talkgraph
