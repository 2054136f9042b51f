#pragma once

#include <string>
#include <vector>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/segments.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

enum class OutputScaling {
  per_dimension,  ///< every dimension divided by its own standard deviation
  common,         ///< all by the root mean square of the standard deviations: their ratios are kept
  none
};
template <>
inline constexpr EnumNames<OutputScaling, 3> enum_names<OutputScaling>{{{OutputScaling::per_dimension, "per_dimension"},
                                                                        {OutputScaling::common, "common"},
                                                                        {OutputScaling::none, "none"}}};

enum class CovarianceApproximation { full, fitc };
template <>
inline constexpr EnumNames<CovarianceApproximation, 2> enum_names<CovarianceApproximation>{
    {{CovarianceApproximation::full, "full"}, {CovarianceApproximation::fitc, "fitc"}}};

enum class LatentStart { pcca, ppca };
template <>
inline constexpr EnumNames<LatentStart, 2> enum_names<LatentStart>{
    {{LatentStart::pcca, "pcca"}, {LatentStart::ppca, "ppca"}}};

/// Trains the SGPDM of one state: maximises Eqn 4.69 over latent points,
/// inducing points and kernel parameters by scaled conjugate gradients, from
/// PCCA or averaged PPCA (docs/method.md §4). Windows of one frame only give an SGPLVM.
///
/// Observation kernels are RBF + bias + white, that of the dynamics RBF +
/// linear + white. A process of at most `inducing` frames is exact whatever the
/// approximation. The latent dimension is lowered to the smaller stream's and
/// to N − 1 (at least 1). A dimension that does not vary keeps scale 1. Data
/// that do not vary at all are not optimised: the model answers with their mean.
///
/// States of speech have few frames (tens) in many dimensions, where maximum
/// likelihood fits the noise: the defaults (few iterations, much noise at first,
/// kernel parameters held near their start, wide dynamics) were chosen on
/// validation clips of GRID s1. The source's own are inverse width 1000, no prior
/// (prior_deviation 0) and more iterations.
///
/// Throws std::runtime_error if there are no frames, windows of unequal length
/// or dimension, or values that are not finite; std::invalid_argument if
/// `fixed` names an unknown parameter.
struct TrainSgpdm {
  int latent_dimension = 3;
  CovarianceApproximation approximation = CovarianceApproximation::fitc;
  int inducing = 100;
  int iterations = 20;
  LatentStart initial = LatentStart::pcca;
  OutputScaling audio_scaling = OutputScaling::per_dimension;
  OutputScaling visual_scaling = OutputScaling::per_dimension;
  bool dynamics = true;
  bool likelihood_bias = true;
  bool dynamics_bias = true;
  double first_variance = 0.1;
  double dynamics_inverse_width = 1;
  double noise = 0.5;
  double minimum_noise = 1e-3;
  double prior_deviation = 0.2;
  std::vector<std::string> fixed = {"dynamics.inverse_width"};

  Sgpdm operator()(const StateData& data, Context& context) const;
};
void describe(Description<TrainSgpdm>& d);

}  // namespace talkgraph
