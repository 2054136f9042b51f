#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

double VariationalLikelihood::noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const {
  lambda.setConstant(conditional.size(), white);
  return -0.5 * conditional.sum() / white;
}

double VariationalLikelihood::noise_gradient(const Eigen::VectorXd& conditional, double white, double outputs,
                                             Eigen::VectorXd& slope) const {
  const double by_white = slope.sum() + 0.5 * outputs * conditional.sum() / (white * white);
  slope.setConstant(-0.5 * outputs / white);
  return by_white;
}

}  // namespace talkgraph
