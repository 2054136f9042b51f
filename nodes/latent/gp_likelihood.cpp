#include "nodes/latent/gp_likelihood.h"

namespace talkgraph {

void GpGradient::set_zero(Eigen::Index n, Eigen::Index k, Eigen::Index d, Eigen::Index parameters) {
  inputs.setZero(n, d);
  inducing.setZero(k, d);
  kernel.setZero(parameters);
}

}  // namespace talkgraph
