#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

double FitcLikelihood::noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const {
  lambda = conditional.array() + white;
  return 0;
}

double FitcLikelihood::noise_gradient(const Eigen::VectorXd&, double, double, Eigen::VectorXd& slope) const {
  return slope.sum();
}

}  // namespace talkgraph
