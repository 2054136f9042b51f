#include "nodes/latent/gp_likelihood.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace talkgraph {

void GpGradient::set_zero(Eigen::Index n, Eigen::Index k, Eigen::Index d, Eigen::Index parameters) {
  inputs.setZero(n, d);
  inducing.setZero(k, d);
  kernel.setZero(parameters);
}

void GpLikelihood::check(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& y) {
  require_dimension(kernel, x.cols());
  if (x.rows() != y.rows() || x.size() == 0 || y.size() == 0)
    throw std::invalid_argument(
        fmt::format("a Gaussian process of {} × {} inputs and {} × {} outputs: it needs at least one frame and one "
                    "dimension, and as many frames of both",
                    x.rows(), x.cols(), y.rows(), y.cols()));
}

void GpLikelihood::check_finite(double value, const GpGradient* gradient, const ConstMatrix& x, const ConstMatrix& u,
                                const ConstMatrix& y) {
  const bool derivatives = !gradient || (gradient->inputs.allFinite() && gradient->inducing.allFinite() &&
                                         gradient->kernel.allFinite() && gradient->outputs.allFinite());
  if (std::isfinite(value) && derivatives) return;
  const auto largest = [](const ConstMatrix& m) { return m.size() > 0 ? m.cwiseAbs().maxCoeff() : 0.0; };
  const char* nan = !x.allFinite()   ? "inputs"
                    : !u.allFinite() ? "inducing points"
                    : !y.allFinite() ? "outputs"
                                     : nullptr;
  throw FactorisationError(
      nan ? fmt::format("the log-likelihood is not finite: the {} are not", nan)
          : fmt::format("the log-likelihood {} not finite: inputs reach {:.3g}, outputs {:.3g}; scale them, or {}",
                        std::isfinite(value) ? "has derivatives that are" : "is", largest(x), largest(y), more_noise));
}

}  // namespace talkgraph
