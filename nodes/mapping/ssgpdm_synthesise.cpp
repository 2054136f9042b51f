#include "nodes/mapping/ssgpdm_synthesise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "nodes/latent/back_constraint.h"
#include "nodes/latent/clock.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/mapping/ssgpdm.h"
#include "nodes/mapping/start_values.h"

namespace talkgraph {

namespace {

using Boundary = std::optional<Eigen::RowVectorXd>;  // visual frame before the segment

void check(const Ssgpdm& model, const Track& audio, const SegmentTrack& segments) {
  if (model.states.empty()) throw std::runtime_error("the switching model has no states; train it first");
  const auto dims = model.states.begin()->second.audio.mean.size();
  if (audio.frames() > 0 && audio.dimension() != dims)
    throw std::runtime_error(
        fmt::format("audio of {} dimensions, but the model was trained on {}: use the same "
                    "speech parameters",
                    audio.dimension(), dims));
  if (!audio.values.allFinite()) throw std::runtime_error("the audio features hold a value that is not finite");
  if (std::abs(audio.frames() - segments.frames) > 2)
    throw std::runtime_error(
        fmt::format("{} audio frames but segments for {}: both must come from one utterance at "
                    "one rate",
                    audio.frames(), segments.frames));
  std::int64_t next = 0;
  for (const auto& s : segments.segments) {
    if (s.start != next || s.length < 1)
      throw std::runtime_error(fmt::format("segment \"{}\" starts at frame {} with {} frames, but frame {} comes next",
                                           s.label, s.start, s.length, next));
    next += s.length;
  }
  if (next != segments.frames)
    throw std::runtime_error(fmt::format("segments end at frame {} of {}", next, segments.frames));
}

/// The latent points of one segment.
class SegmentSearch {
 public:
  SegmentSearch(const SynthesiseSsgpdm& node, const Sgpdm& state, const Eigen::MatrixXd& audio, const Boundary& before)
      : node_(node), state_(state), audio_(audio), before_(before) {
    x_ = start();
    optimiser_.iterations = node.iterations;
    optimiser_.step_tolerance = optimiser_.cost_tolerance = 1e-3;
  }

  SegmentLatents latents() {
    const bool moves = node_.dynamics && state_.dynamics && x_.rows() > 1;
    switch (node_.method) {
      case LatentSearch::initial:
        break;
      case LatentSearch::optimise:
        moves ? optimise(0, x_.rows(), true) : points();
        break;
      case LatentSearch::predict:
        moves ? predict() : points();
        break;
    }
    return {std::move(x_), evaluated_, converged_};
  }

 private:
  Eigen::MatrixXd start() const {
    switch (node_.initial) {
      case LatentInitial::frame:
        return nearest_frames(state_, audio_);
      case LatentInitial::window:
        return nearest_window(state_, audio_);
      case LatentInitial::hmm:
        return likeliest_path(state_, audio_, node_.hmm_states);
      case LatentInitial::back_constraint:
        break;
    }
    if (!state_.back_constraint)
      throw std::runtime_error("state \"" + state_.label +
                               "\" has no back-constraint to start from: train it with one (back_constraint of "
                               "latent.sgpdm), or set initial to window");
    return latent_points(*state_.back_constraint, audio_);
  }
  void optimise(Eigen::Index from, Eigen::Index count, bool with_dynamics) {
    const Eigen::MatrixXd audio = audio_.middleRows(from, count);
    SequenceObjective objective(state_, audio, with_dynamics);
    if (from == 0 && before_ && node_.smoothness > 0) objective.follow(*before_, node_.smoothness);
    Eigen::VectorXd p = x_.middleRows(from, count).reshaped();
    const StopReason reason = optimiser_.minimise(objective, p).reason;
    evaluated_ = evaluated_ && reason != StopReason::failed;
    converged_ = converged_ && evaluated_ && reason != StopReason::iterations;
    x_.middleRows(from, count) = p.reshaped(count, x_.cols());
  }
  void points() {
    for (Eigen::Index t = 0; t < x_.rows(); ++t) optimise(t, 1, false);
  }
  void predict() {
    optimise(0, 1, false);
    Predictive h;
    if (is_timed(state_.form)) {
      h.compute(*state_.dynamics, times_of({x_.rows()}, state_.form));
      x_.bottomRows(x_.rows() - 1) = h.mean().bottomRows(x_.rows() - 1);
      return;
    }
    for (Eigen::Index t = 1; t < x_.rows(); ++t) {
      h.compute(*state_.dynamics, x_.row(t - 1));
      x_.row(t) = h.mean();
      if (state_.form == DynamicsForm::difference) x_.row(t) += x_.row(t - 1);
    }
  }

  const SynthesiseSsgpdm& node_;
  const Sgpdm& state_;
  const Eigen::MatrixXd& audio_;
  const Boundary& before_;
  Eigen::MatrixXd x_;
  bool evaluated_ = true, converged_ = true;
  ScaledConjugateGradients optimiser_;
};

Track track_like(const Track& audio, Eigen::Index frames, Eigen::Index dims) {
  Track t;
  t.values.setZero(frames, dims);
  t.rate = audio.rate;
  t.start = audio.start;
  t.lost = audio.lost;
  std::erase_if(t.lost, [&](auto frame) { return frame >= frames; });
  return t;
}

}  // namespace

SegmentLatents segment_latents(const SynthesiseSsgpdm& search, const Sgpdm& state, const Eigen::MatrixXd& audio,
                               const Boundary& before) {
  return SegmentSearch(search, state, audio, before).latents();
}

SynthesiseSsgpdm::Out SynthesiseSsgpdm::operator()(const Ssgpdm& model, const Track& audio,
                                                   const SegmentTrack& segments, Context& context) const {
  check(model, audio, segments);
  const Eigen::Index frames = std::min<Eigen::Index>(audio.frames(), segments.frames);
  const Eigen::Index dimension = model.states.begin()->second.visual.mean.size();
  Eigen::Index d = 0;
  for (const auto& [label, state] : model.states) d = std::max(d, state.latents.cols());
  Out out{track_like(audio, frames, dimension), track_like(audio, frames, dimension), track_like(audio, frames, d), {}};
  out.states.frames = frames;
  out.states.rate = segments.rate;
  Predictive visual;
  std::size_t converged = 0;
  for (const auto& segment : segments.segments) {
    const Eigen::Index length = std::min<Eigen::Index>(segment.length, frames - segment.start);
    if (length < 1) break;
    context.check_cancelled();
    const Eigen::MatrixXd heard = audio.values.middleRows(segment.start, length);
    const Sgpdm& state = state_for(model, segment.label, heard.colwise().mean());
    Boundary before;
    if (segment.start > 0) before = scaled(state.visual, out.visual.values.row(segment.start - 1));
    const Eigen::MatrixXd scaled_audio = scaled(state.audio, heard);
    const SegmentLatents found = segment_latents(*this, state, scaled_audio, before);
    visual.compute(state.visual, found.points);
    if (!found.evaluated || !visual.mean().allFinite())
      throw std::runtime_error(
          fmt::format("segment \"{}\" from frame {} on: state \"{}\" has no finite likelihood there: its model holds "
                      "values that are not finite, or the sound is far from all that it was trained on",
                      segment.label, segment.start, state.label));
    converged += found.converged;
    out.latents.values.block(segment.start, 0, length, found.points.cols()) = found.points;
    out.states.segments.push_back({state.label, segment.start, length});
    out.visual.values.middleRows(segment.start, length) = unscaled(state.visual, visual.mean());
    out.deviation.values.middleRows(segment.start, length) = visual.variance().cwiseSqrt() * state.visual.scale;
    context.progress(static_cast<double>(segment.start + length) / static_cast<double>(frames));
  }
  if (method != LatentSearch::initial)
    context.log(fmt::format("{} of {} segments converged within {} iterations", converged, out.states.segments.size(),
                            iterations));
  return out;
}

void describe(Description<SynthesiseSsgpdm>& d) {
  d.type("mapping.ssgpdm_synthesise").version(4);
  d.summary("visual features of new speech by a switching SGPDM").stored();
  d.source("Thesis §4.4, §5.3, Eqns 4.76-4.79, Algorithms 7 and 8, corrected as in docs/method.md §5");
  d.input("model", "the switching model")
      .input("audio", "speech features at the video rate")
      .input("segments", "states of the speech");
  d.output("visual", &SynthesiseSsgpdm::Out::visual, "mean of the visual process");
  d.output("deviation", &SynthesiseSsgpdm::Out::deviation, "predictive standard deviation of every value");
  d.output("latents", &SynthesiseSsgpdm::Out::latents, "the latent points found");
  d.output("states", &SynthesiseSsgpdm::Out::states, "the segments, with the labels of the states that answered");
  d.param("method", &SynthesiseSsgpdm::method)
      .doc("optimise: Algorithm 7; predict: Algorithm 8; initial: nearest neighbours only");
  d.param("initial", &SynthesiseSsgpdm::initial)
      .doc(
          "start values: each frame's nearest training frame, the nearest training window, the back-constraint, or the "
          "likeliest path through training points as states of a hidden Markov model");
  d.param("hmm_states", &SynthesiseSsgpdm::hmm_states)
      .at_least(0)
      .doc("most training points that are states of the hidden Markov model, a random subset of more; 0: all");
  d.param("smoothness", &SynthesiseSsgpdm::smoothness)
      .at_least(0)
      .doc("weight of the term that draws a segment's first frame to the end of the one before; 0: none");
  d.param("dynamics", &SynthesiseSsgpdm::dynamics).doc("off: every frame is optimised by itself");
  d.param("iterations", &SynthesiseSsgpdm::iterations).at_least(0).doc("limit of scaled conjugate gradients a segment");
}

}  // namespace talkgraph
