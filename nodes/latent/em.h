#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "graph/context.h"
#include "graph/description.h"

namespace talkgraph {

/// When expectation maximisation ends.
struct EmLimits {
  int iterations;
  double tolerance;                          ///< of what the log-likelihood gains in an iteration, a frame
  const char* objective = "log-likelihood";  ///< what rises, for the log
};

/// Expectation maximisation. `expect` gives the log-likelihood under the model as it is, and keeps what `maximise`
/// makes the next model of. Gives the log-likelihood at the start and after each iteration; the last is that of the
/// model. `subject` ("GMM of 8 components") stands in the log.
template <class Expect, class Maximise>
std::vector<double> run_em(const EmLimits& limits, Eigen::Index frames, const std::string& subject, Context& context,
                           Expect expect, Maximise maximise) {
  std::vector<double> trace{expect()};
  bool settled = false;
  for (int i = 0; i < limits.iterations && !settled; ++i) {
    context.check_cancelled();
    maximise();
    trace.push_back(expect());
    if (!std::isfinite(trace.back()))
      throw std::runtime_error(fmt::format("{}: the {} is {} after {} iterations: are values of the features huge?",
                                           subject, limits.objective, trace.back(), i + 1));
    settled = trace.back() - trace[trace.size() - 2] <= limits.tolerance * static_cast<double>(frames);
    context.progress(static_cast<double>(i + 1) / limits.iterations);
  }
  context.log(fmt::format("{}, {} frames: {} {:.8g}, {:.5g} a frame, after {} iterations{}", subject, frames,
                          limits.objective, trace.back(), trace.back() / static_cast<double>(frames), trace.size() - 1,
                          settled ? "" : ", not converged"));
  return trace;
}

/// The parameters of a node that trains so; `what` has variances ("a component").
template <class Node>
void describe_em(Description<Node>& d, const std::string& what) {
  d.param("floor", &Node::floor)
      .positive()
      .doc("least variance of " + what + " in any direction, as a share of the frames' variance a dimension");
  d.param("iterations", &Node::iterations).at_least(0).doc("limit of expectation maximisation");
  d.param("tolerance", &Node::tolerance)
      .at_least(0)
      .doc("it ends when the log-likelihood gains no more than this in an iteration, a frame");
}

}  // namespace talkgraph
