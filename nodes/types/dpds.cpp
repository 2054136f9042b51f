#include "nodes/types/dpds.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const Dpds& d) {
  const StoredModel stored("deterministic process dynamical system");
  const Eigen::Index k = d.chain.size(), dims = d.visual.mean.size();
  stored.scaling("visual", d.visual, dims);
  stored.matrix("first", d.first, k, dims);
  stored.matrix("prediction", d.prediction, k, dims);
  stored.matrix("offset", d.offset, k, dims);
  stored.variances("noise", d.noise, 1, dims);
}

}  // namespace

void fields(Archive& ar, Dpds& d) {
  ar("visual", d.visual);
  ar("chain", d.chain);
  ar("first", d.first);
  ar("prediction", d.prediction);
  ar("offset", d.offset);
  ar("noise", d.noise);
  ar("trace", d.trace);
  if (ar.loading()) check(d);
}

}  // namespace talkgraph
