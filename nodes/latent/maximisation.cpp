#include "nodes/latent/maximisation.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "nodes/latent/checkpoint.h"
#include "nodes/latent/lbfgs.h"
#include "nodes/latent/scg.h"

namespace talkgraph {

namespace {

std::unique_ptr<Optimiser> make_optimiser(OptimiserKind kind) {
  if (kind == OptimiserKind::lbfgs) return std::make_unique<Lbfgs>();
  return std::make_unique<ScaledConjugateGradients>();
}

/// Of where an optimisation starts, which stands for all that its steps depend on, and of where it ends.
Key key_of(const std::string& subject, Maximand& maximand, Eigen::VectorXd start, Maximisation how) {
  std::string what = subject;
  Eigen::VectorXd gradient;
  double cost = 0;
  maximand.evaluate(start, cost, &gradient);
  return content_key([&](Archive& ar) {
    ar("subject", what);
    ar("start", start);
    ar("cost", cost);
    ar("gradient", gradient);
    ar("hold", how.hold_noise);
    ar("optimiser", how.optimiser);
    ar("iterations", how.iterations);
    ar("time_limit", how.time_limit);
  });
}

}  // namespace

OptimiserState Maximisation::maximise(const std::string& subject, Maximand& maximand, const Eigen::VectorXd& start,
                                      Context& context) const {
  const auto started = std::chrono::steady_clock::now();
  OptimiserState state;
  bool noise_held = false;
  Checkpoint saved(
      checkpoint, [&] { return key_of(subject, maximand, start, *this); },
      [&](Archive& ar) {
        ar("state", state);
        ar("noise_held", noise_held);
      });
  if (!saved.load(subject, context)) {
    state = {};
    state.parameters = start;
    noise_held = hold_noise > 0;
  }

  const auto by = make_optimiser(optimiser);
  if (time_limit > 0) by->seconds = time_limit;
  by->on_iteration = [&](int i, double) {
    saved.between_steps(context);
    context.progress(static_cast<double>(i) / iterations);
  };
  if (noise_held) {
    maximand.hold_noise(true);
    by->iterations = std::min(hold_noise, iterations);
    talkgraph::maximise(*by, maximand, state);
    maximand.hold_noise(false);
    noise_held = false;
    by->seconds -= std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    if (state.report.reason != StopReason::time) state.restart();
  }
  by->iterations = iterations;
  if (state.report.reason != StopReason::time) talkgraph::maximise(*by, maximand, state);
  saved.remove();
  return state;
}

}  // namespace talkgraph
