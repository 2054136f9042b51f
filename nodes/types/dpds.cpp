#include "nodes/types/dpds.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const Dpds& d) {
  const StoredModel stored("deterministic process dynamical system");
  const Eigen::Index k = std::ssize(d.phones), dims = d.visual.mean.size();
  stored.scaling("visual", d.visual, dims);
  stored.sorted("phones", d.phones);
  stored.matrix("first", d.first, k, dims);
  stored.matrix("prediction", d.prediction, k, dims);
  stored.matrix("offset", d.offset, k, dims);
  stored.variances("noise", d.noise, 1, dims);
  stored.matrix("start", d.start, k, 1);
  stored.weights("start", d.start);
  stored.matrix("transitions", d.transitions, k, k);
  stored.weights("transitions", d.transitions);
}

}  // namespace

void fields(Archive& ar, Dpds& d) {
  ar("visual", d.visual);
  ar("phones", d.phones);
  ar("first", d.first);
  ar("prediction", d.prediction);
  ar("offset", d.offset);
  ar("noise", d.noise);
  ar("start", d.start);
  ar("transitions", d.transitions);
  ar("trace", d.trace);
  if (ar.loading()) check(d);
}

}  // namespace talkgraph
