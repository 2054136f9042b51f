#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/latent/sgpdm.h"
#include "nodes/types/report.h"
#include "nodes/types/segments.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

enum class VisualOnly {
  keep,    ///< the model has them: their values come from training frames and dynamics
  average  ///< the visual process is averaged over them, N(0, 1) each
};
template <>
inline constexpr EnumNames<VisualOnly, 2> enum_names<VisualOnly>{
    {{VisualOnly::keep, "keep"}, {VisualOnly::average, "average"}}};

/// Trains a state's latent model by variational inference, so that it finds its dimension and which dimensions audio
/// and visual features share (docs/method.md §4): the Bayesian GPLVM (Titsias and Lawrence 2010) of two streams,
/// manifold relevance determination (Damianou, Ek, Titsias and Lawrence 2012).
///
/// A dimension's relevance to a stream is its inverse width times the variance of the latent means along it, as a
/// share of the largest of that stream. The model has those relevant to the audio stream (at least one) and, if
/// wanted, those of the visual stream only; its processes are averaged over the others, N(0, 1) each: exactly as to the
/// mean, but for the kernel's bias as to the variance. Its latent points are the means of q(X), its kernels ARD + bias
/// + white, its dynamics are learnt on the means.
///
/// NaN marks a missing value. Outputs that are missing in the same frames have their own inducing variables, so that
/// each value that is there counts as it should and no other does; a frame with nothing in one stream has its latent
/// point from the other, one with nothing at all from its neighbours in time (`time_width`) or the prior. Start values
/// and the nearest neighbours of synthesis take the mean instead. The model's predictive variance is the mean over
/// outputs.
///
/// All frames at once are optimised by conjugate gradients or L-BFGS; with `batch`, parts of them by stochastic steps
/// (StochasticTraining), for thousands of frames; the trace is of the bound after each epoch. Either way time grows
/// with N·inducing², memory with N.
///
/// Throws std::runtime_error if there are no frames, windows of unequal length or dimension, infinite values, a
/// dimension that is missing throughout.
struct TrainMrd : Maximisation {
  struct Out {
    Sgpdm model;
    Table relevance;   ///< a row a dimension found: its relevance to audio and visual stream
    Table dimensions;  ///< one row: frames, dimensions shared, of audio only, of visual only; bound a frame
  };
  int latent_dimension = 8;
  int inducing = 30;
  int batch = 0;
  int epochs = 50;
  double time_width = 0;
  OutputScaling audio_scaling = OutputScaling::per_dimension;
  OutputScaling visual_scaling = OutputScaling::per_dimension;
  double noise = 0.1;
  double minimum_noise = 1e-3;
  double relevant = 0.05;
  VisualOnly visual_only = VisualOnly::average;
  bool dynamics = true;
  bool dynamics_bias = true;
  double dynamics_inverse_width = 1;
  double first_variance = 1;

  TrainMrd() {
    iterations = 120;
    hold_noise = 20;
  }
  Out operator()(const StateData& data, Context& context, Random& random) const;
};
void describe(Description<TrainMrd>& d);

}  // namespace talkgraph
