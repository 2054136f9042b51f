#include "nodes/latent/latent_dynamics.h"

#include <cmath>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/objective.h"
#include "nodes/latent/scg.h"

namespace talkgraph {

namespace {

struct Steps {
  Eigen::MatrixXd from, to;
};

Steps steps_of(const Eigen::MatrixXd& x, const std::vector<std::int64_t>& lengths) {
  const Eigen::Index count = x.rows() - static_cast<Eigen::Index>(lengths.size());
  Steps steps{Eigen::MatrixXd(count, x.cols()), Eigen::MatrixXd(count, x.cols())};
  Eigen::Index row = 0, at = 0;
  for (const auto length : lengths) {
    steps.from.middleRows(at, length - 1) = x.middleRows(row, length - 1);
    steps.to.middleRows(at, length - 1) = x.middleRows(row + 1, length - 1);
    row += length;
    at += length - 1;
  }
  return steps;
}

/// Negative log-likelihood as a function of the log kernel parameters, but the first term's inverse width.
class KernelObjective : public Objective {
 public:
  KernelObjective(GpLikelihood& likelihood, Kernel kernel, const Steps& steps, const Eigen::MatrixXd& inducing)
      : likelihood_(likelihood), kernel_(std::move(kernel)), steps_(steps), inducing_(inducing) {}
  Eigen::Index size() const override { return parameter_count(kernel_); }
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) override {
    set_log_parameters(kernel_, parameters);
    gradient_.set_zero(steps_.from.rows(), inducing_.rows(), steps_.from.cols(), size());
    try {
      cost = -likelihood_.evaluate(kernel_, steps_.from, inducing_, steps_.to, gradient ? &gradient_ : nullptr);
    } catch (const FactorisationError&) {
      return false;
    }
    if (gradient) {
      *gradient = -gradient_.kernel;
      (*gradient)[1] = 0;
    }
    return std::isfinite(cost);
  }
  GaussianProcess posterior(const Eigen::VectorXd& parameters) {
    set_log_parameters(kernel_, parameters);
    return likelihood_.posterior(kernel_, steps_.from, inducing_, steps_.to);
  }

 private:
  GpLikelihood& likelihood_;
  Kernel kernel_;
  const Steps& steps_;
  const Eigen::MatrixXd& inducing_;
  GpGradient gradient_;
};

}  // namespace

GaussianProcess fit_dynamics(const Eigen::MatrixXd& latents, const std::vector<std::int64_t>& lengths,
                             double inverse_width, int inducing, int iterations) {
  const Steps steps = steps_of(latents, lengths);
  const Kernel kernel{{RbfTerm{0.1, inverse_width}, LinearTerm{1}, WhiteTerm{0.5, 1e-3}}};
  const bool sparse = steps.from.rows() > inducing;
  Eigen::MatrixXd points(sparse ? inducing : 0, latents.cols());
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = steps.from.row(i * steps.from.rows() / inducing);
  FullLikelihood full;
  FitcLikelihood fitc;
  KernelObjective objective(sparse ? static_cast<GpLikelihood&>(fitc) : full, kernel, steps, points);
  Eigen::VectorXd parameters = log_parameters(kernel);
  ScaledConjugateGradients optimiser;
  optimiser.iterations = iterations;
  optimiser.minimise(objective, parameters);
  GaussianProcess process = objective.posterior(parameters);
  process.mean = Eigen::RowVectorXd::Zero(latents.cols());
  process.scale = Eigen::RowVectorXd::Ones(latents.cols());
  return process;
}

}  // namespace talkgraph
