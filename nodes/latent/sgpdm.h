#pragma once

#include "nodes/latent/latent_training.h"
#include "nodes/types/segments.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

enum class LatentStart { pcca, ppca, cca };
template <>
inline constexpr EnumNames<LatentStart, 3> enum_names<LatentStart>{
    {{LatentStart::pcca, "pcca"}, {LatentStart::ppca, "ppca"}, {LatentStart::cca, "cca"}}};

/// Trains the SGPDM of one state: maximises Eqn 4.69 from the posterior mean of
/// PCCA, the average of both streams' PPCA, or that of their canonical
/// projections (docs/method.md §4). Windows of one frame only give an SGPLVM.
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
struct TrainSgpdm : LatentTraining {
  LatentStart initial = LatentStart::pcca;
  OutputScaling audio_scaling = OutputScaling::per_dimension;
  OutputScaling visual_scaling = OutputScaling::per_dimension;
  bool likelihood_bias = true;

  Sgpdm operator()(const StateData& data, Context& context) const;
};
void describe(Description<TrainSgpdm>& d);

}  // namespace talkgraph
