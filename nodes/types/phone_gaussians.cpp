#include "nodes/types/phone_gaussians.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const PhoneGaussians& g) {
  const StoredModel stored("model of trajectories through phones");
  const Eigen::Index rows = std::ssize(g.phones) + 1, dims = g.scaling.mean.size();
  stored.sorted("phones", g.phones);
  stored.matrix("means", g.means, rows, dims);
  stored.variances("variances", g.variances, rows, dims);
  stored.positive("smoothness", g.smoothness);
  stored.require(g.order >= 1 && g.order <= 10, "order", "is not from 1 to 10");
  stored.scaling("scaling", g.scaling, dims);
}

}  // namespace

void fields(Archive& ar, PhoneGaussians& g) {
  ar("phones", g.phones);
  ar("means", g.means);
  ar("variances", g.variances);
  ar("smoothness", g.smoothness);
  ar("order", g.order);
  ar("scaling", g.scaling);
  ar("trace", g.trace);
  if (ar.loading()) check(g);
}

}  // namespace talkgraph
