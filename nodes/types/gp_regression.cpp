#include "nodes/types/gp_regression.h"

namespace talkgraph {

void fields(Archive& ar, GpRegression& g) {
  ar("inputs", g.inputs);
  ar("process", g.process);
  ar("log_likelihood", g.log_likelihood);
  ar("iterations", g.iterations);
  ar("jitter", g.jitter);
}

}  // namespace talkgraph
