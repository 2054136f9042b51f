#include "nodes/latent/gpdm_infer.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/latent/back_constraint.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sequences.h"

namespace talkgraph {

namespace {

/// What sequence optimisation looks at, the one stream in the place of the audio.
Sgpdm as_state(const Gpdm& model) {
  Sgpdm state;
  state.latents = model.latents;
  state.audio = model.observations;
  state.dynamics = model.dynamics;
  state.form = model.form;
  state.dynamics_bias = model.dynamics_bias;
  state.first_variance = model.first_variance;
  return state;
}

Eigen::MatrixXd nearest_points(const Gpdm& model, const Eigen::MatrixXd& frames) {
  Predictive given;
  given.compute(model.observations, model.latents);
  Eigen::MatrixXd x(frames.rows(), model.latents.cols());
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    Eigen::Index nearest = 0;
    (given.mean().rowwise() - frames.row(t)).rowwise().squaredNorm().minCoeff(&nearest);
    x.row(t) = model.latents.row(nearest);
  }
  return x;
}

Eigen::MatrixXd start_points(const Gpdm& model, const Eigen::MatrixXd& frames, GpdmStart initial) {
  if (initial == GpdmStart::nearest) return nearest_points(model, frames);
  if (!model.back_constraint)
    throw std::runtime_error(
        "the model has no back-constraint to start from: train it with one (back_constraint of latent.gpdm), or set "
        "initial to nearest");
  return latent_points(*model.back_constraint, frames);
}

}  // namespace

InferGpdm::Out InferGpdm::operator()(const Gpdm& model, const Track& track, Context& context) const {
  require_frames_of(track, model.observations.mean.size(), "the model");
  const Track like{{}, track.rate, track.start, {}, track.lost};
  Out out{like, like, like};
  out.track.names = out.deviation.names = model.names;
  out.latents.values.setZero(track.frames(), model.latents.cols());

  const Sgpdm state = as_state(model);
  ScaledConjugateGradients optimiser;
  optimiser.iterations = iterations;
  double log_likelihood = 0;
  Eigen::Index seen = 0;
  for (Eigen::Index from = 0, to = 0; from < track.frames(); from = to + 1) {
    for (to = from; to < track.frames() && !track.is_lost(to);) ++to;
    if (to == from) continue;
    context.check_cancelled();
    const Eigen::MatrixXd frames = scaled(model.observations, track.values.middleRows(from, to - from));
    SequenceObjective objective(state, frames, dynamics);
    Eigen::VectorXd x = start_points(model, frames, initial).reshaped();
    const OptimiserReport report = optimiser.minimise(objective, x);
    if (report.reason == StopReason::failed)
      throw std::runtime_error(
          fmt::format("frames {} to {} are too far from all that the model was trained on: their likelihood is not "
                      "finite",
                      from, to - 1));
    out.latents.values.middleRows(from, to - from) = x.reshaped(to - from, model.latents.cols());
    log_likelihood -= report.cost;
    seen += to - from;
  }
  Predictive given;
  given.compute(model.observations, out.latents.values);
  out.track.values = unscaled(model.observations, given.mean());
  out.deviation.values = given.variance().cwiseSqrt() * model.observations.scale;
  if (seen > 0)
    context.log(fmt::format("{} frames, ln p(frames, latents) = {:.5g} a scaled frame", seen,
                            log_likelihood / static_cast<double>(seen)));
  return out;
}

void describe(Description<InferGpdm>& d) {
  d.type("latent.gpdm_infer").version(1);
  d.summary("latent points of a track under a trained GPDM or GPLVM, and the track that they give");
  d.source("Thesis §4.4, Eqns 4.77-4.79, of one stream");
  d.input("model", "trained on features of this kind").input("track", "of the features that the model was trained on");
  d.output("latents", &InferGpdm::Out::latents, "T × d")
      .output("track", &InferGpdm::Out::track, "what the latent points give, T × D")
      .output("deviation", &InferGpdm::Out::deviation, "predictive standard deviation of every value");
  d.param("initial", &InferGpdm::initial)
      .doc("start values: the training point that gives the nearest frame, or the back-constraint");
  d.param("dynamics", &InferGpdm::dynamics).doc("off: every frame is optimised by itself");
  d.param("iterations", &InferGpdm::iterations).at_least(0).doc("limit of scaled conjugate gradients a sequence");
}

}  // namespace talkgraph
