#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/phone_gaussians.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Ezzat's trajectory synthesis (Ezzat, Geiger and Poggio 2002): a Gaussian of visual parameters a phone, means and
/// variances over its training frames, and smooth trajectories through the phones' means. Each dimension of a
/// trajectory y minimises
///
///     Σ_t (y_t − μ_t)² / (n_t σ²_t) + λ Σ_t (Δ^k y)²_t        (Eqn 4.8)
///
/// with the mean and variance of the phone of frame t, the number n_t of frames that the phone lasts there, and
/// differences of order k. Then means and logarithms of variances take steps of scaled conjugate gradients down the
/// mean squared error of the trajectories of all training sequences.
///
/// Parameters are scaled to mean 0 and deviation 1 first, so that λ is in their units. Of the source this differs in
/// the descent, which has no learning rates, and in its features, for which any will do. Every run of measured frames
/// is a sequence. Throws std::runtime_error, naming the track, if none has labels and a measured frame, if lengths
/// differ by more than two frames, on different dimensions, and on values that are not finite.
struct TrainPhoneGaussians {
  double smoothness = 1;
  int order = 2;
  double floor = 1e-3;
  int descent = 60;

  PhoneGaussians operator()(const Collected<Track>& visual, const Collected<FrameLabels>& labels,
                            Context& context) const;
};
void describe(Description<TrainPhoneGaussians>& d);

/// The trajectory through the phones' means. A phone that training had none of stands at the training mean, with the
/// variance of all frames.
struct SynthesisePhoneGaussians {
  Track operator()(const PhoneGaussians& model, const FrameLabels& labels) const;
};
void describe(Description<SynthesisePhoneGaussians>& d);

}  // namespace talkgraph
