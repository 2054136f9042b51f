#include "nodes/latent/latent_dynamics.h"

#include "nodes/latent/gp_objective.h"
#include "nodes/latent/latent_training.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sequences.h"

namespace talkgraph {

namespace {

/// The inverse width of the first term, an RBF, stays.
class WidthHeld : public GpObjective {
 public:
  using GpObjective::GpObjective;

 private:
  double compute(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) override {
    const double value = GpObjective::compute(parameters, gradient);
    if (gradient) (*gradient)[1] = 0;
    return value;
  }
};

}  // namespace

GaussianProcess fit_dynamics(const Eigen::MatrixXd& latents, const std::vector<std::int64_t>& lengths,
                             double inverse_width, int inducing, int iterations) {
  const Steps steps = steps_of(latents, lengths);
  const auto [likelihood, points] = approximate_gp(CovarianceApproximation::fitc, steps.from, lengths, inducing);
  WidthHeld objective(*likelihood, {{RbfTerm{0.1, inverse_width}, LinearTerm{1}, WhiteTerm{0.5, 1e-3}}}, steps.from,
                      points, true, steps.to);
  Eigen::VectorXd parameters = objective.start();
  ScaledConjugateGradients optimiser;
  optimiser.iterations = iterations;
  maximise(optimiser, objective, parameters);
  GaussianProcess process = objective.posterior(parameters);
  process.mean = Eigen::RowVectorXd::Zero(latents.cols());
  process.scale = Eigen::RowVectorXd::Ones(latents.cols());
  return process;
}

}  // namespace talkgraph
