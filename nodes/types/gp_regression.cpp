#include "nodes/types/gp_regression.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

void fields(Archive& ar, GpRegression& g) {
  ar("inputs", g.inputs);
  ar("process", g.process);
  ar("log_likelihood", g.log_likelihood);
  ar("iterations", g.iterations);
  ar("frames", g.frames);
  ar("trace", g.trace);
  ar("ended", g.ended);
  ar("jitter", g.jitter);
  if (!ar.loading()) return;
  const Eigen::Index inputs = g.inputs.mean.size() * (2 * g.inputs.context + 1);
  StoredModel("Gaussian process").process("process", g.process, inputs, g.process.mean.size());
}

}  // namespace talkgraph
