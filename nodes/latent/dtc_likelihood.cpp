#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

double DtcLikelihood::noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const {
  lambda.setConstant(conditional.size(), white);
  return 0;
}

double DtcLikelihood::noise_gradient(const Eigen::VectorXd&, double, double, Eigen::VectorXd& slope) const {
  const double by_white = slope.sum();
  slope.setZero();
  return by_white;
}

}  // namespace talkgraph
