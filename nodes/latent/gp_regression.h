#pragma once

#include <vector>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/latent/latent_training.h"
#include "nodes/types/gp_regression.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class KernelKind { rbf, ard, linear, bias, white };
template <>
inline constexpr EnumNames<KernelKind, 5> enum_names<KernelKind>{{{KernelKind::rbf, "rbf"},
                                                                  {KernelKind::ard, "ard"},
                                                                  {KernelKind::linear, "linear"},
                                                                  {KernelKind::bias, "bias"},
                                                                  {KernelKind::white, "white"}}};

/// A term of a kernel as a graph gives it.
struct KernelChoice {
  KernelKind kind = KernelKind::rbf;
  double variance = 1;
  double inverse_width = 1;
  double minimum = 0;
};
void parameters(Parameters<KernelChoice>& p);
/// For inputs of d dimensions.
Kernel kernel_of(const std::vector<KernelChoice>& terms, Eigen::Index d);

/// Gaussian process regression from audio features with ±`context` neighbours to visual parameters: one kernel for all
/// of them, trained by maximum likelihood over its parameters and the inducing points.
///
/// Inputs are z-scored and divided by the root of their number, so that an inverse width of 1 is about the right size
/// whatever the number of neighbours; visual parameters are centred and divided by their deviations. With no more
/// frames than inducing points the process is exact. Inducing points start from frames at even distances.
///
/// Throws std::runtime_error on no frames, NaN, and dimensions or lengths that do not fit; FactorisationError where the
/// kernel has no noise and the approximation needs it.
struct TrainGp : Maximisation {
  int context = 5;
  std::vector<KernelChoice> kernel = {
      {KernelKind::rbf, 1, 1, 0}, {KernelKind::bias, 0.1, 1, 0}, {KernelKind::white, 0.5, 1, 1e-3}};
  CovarianceApproximation approximation = CovarianceApproximation::fitc;
  int inducing = 100;
  bool fix_inducing = false;

  TrainGp() { iterations = 100; }
  GpRegression operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const;
};
void describe(Description<TrainGp>& d);

/// The mean of the process at every frame, and its standard deviation, noise included.
struct PredictGp {
  struct Prediction {
    Track track, deviation;  ///< T × D
  };
  Prediction operator()(const GpRegression& model, const Track& audio) const;
};
void describe(Description<PredictGp>& d);

}  // namespace talkgraph
