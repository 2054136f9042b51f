#pragma once

#include <string>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/latent/maximand.h"

namespace talkgraph {

enum class OptimiserKind { scg, lbfgs };
template <>
inline constexpr EnumNames<OptimiserKind, 2> enum_names<OptimiserKind>{
    {{OptimiserKind::scg, "scg"}, {OptimiserKind::lbfgs, "lbfgs"}}};

/// How a model's objective is raised: by what, for how long, and what is saved on the way.
struct Maximisation {
  OptimiserKind optimiser = OptimiserKind::scg;
  int iterations = 20;
  int hold_noise = 0;
  double time_limit = 0;
  std::string checkpoint;

  /// From `start`, or from where a checkpoint of the same training stands, which is gone at the end. `subject`
  /// ("state \"t\"") stands in messages. Throws Cancelled, leaving a checkpoint, and FactorisationError if nothing can
  /// be computed at the start.
  OptimiserState maximise(const std::string& subject, Maximand& maximand, const Eigen::VectorXd& start,
                          Context& context) const;
};

template <class Node>
void describe_maximisation(Description<Node>& d) {
  const auto param = [&]<class M>(const char* name, M Maximisation::*member) {
    return d.param(name, static_cast<M Node::*>(member));
  };
  param("optimiser", &Maximisation::optimiser).doc("scaled conjugate gradients, or L-BFGS");
  param("iterations", &Maximisation::iterations).at_least(0).doc("limit of the optimiser");
  param("hold_noise", &Maximisation::hold_noise)
      .at_least(0)
      .doc("first iterations in which noise stays as it is, so that it does not swallow the signal");
  param("time_limit", &Maximisation::time_limit)
      .at_least(0)
      .doc(
          "seconds after which training stops, counted anew where it is gone on with; 0: none. What comes of it "
          "depends on "
          "the machine");
  param("checkpoint", &Maximisation::checkpoint)
      .doc("folder where unfinished training is saved every ten seconds and gone on from after a kill; empty: none");
}

}  // namespace talkgraph
