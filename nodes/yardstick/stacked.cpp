#include "nodes/yardstick/stacked.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "nodes/types/centred.h"
#include "nodes/types/paired.h"

namespace talkgraph {
namespace {

/// The tracks of one utterance and how many frames they have in common.
struct Pair {
  const Track* audio;
  const Track* visual;
  Eigen::Index frames;

  auto audio_values() const { return audio->values.topRows(frames); }
};

std::vector<Pair> pair_up(const Collected<Track>& audio, const Collected<Track>& visual) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const Track *a = &audio[i], *v = visual.find(audio.key(i));
    if (!v) continue;
    const Eigen::Index frames = common_frames(audio.key(i), a->frames(), "audio frames", v->frames(), "visual frames");
    for (const auto& [track, what] : {std::pair(a, "audio"), std::pair(v, "visual")})
      if (!track->values.allFinite())
        throw std::runtime_error(audio.key(i) + ": NaN or infinite " + what + " features: look at the stage before");
    pairs.push_back({a, v, frames});
    if (a->dimension() != pairs[0].audio->dimension() || v->dimension() != pairs[0].visual->dimension())
      throw std::runtime_error(audio.key(i) + ": other dimensions than the tracks before");
    if (a->dimension() == 0 || v->dimension() == 0)
      throw std::runtime_error(audio.key(i) + ": " + std::to_string(a->dimension()) + " audio and " +
                               std::to_string(v->dimension()) + " visual dimensions, nothing to learn");
  }
  return pairs;
}

/// Scales the audio of all pairs, n frames together, to mean 0 and deviation 1; what does not vary, to 0.
void z_score(StackedInputs& inputs, const std::vector<Pair>& pairs, Eigen::Index n) {
  Eigen::MatrixXd heard(n, inputs.mean.size());
  Eigen::Index at = 0;
  for (const auto& p : pairs) {
    heard.middleRows(at, p.frames) = p.audio_values();
    at += p.frames;
  }
  const CentredFrames frames = centred(heard);
  inputs.mean = frames.mean;
  inputs.scale = (frames.deviation.array() > 0).select(frames.deviation.cwiseInverse(), 0.0);
}

}  // namespace

Eigen::MatrixXd stacked(const StackedInputs& inputs, const Track& audio) {
  const auto frames = audio.frames(), dimension = audio.dimension();
  if (dimension != inputs.mean.size())
    throw std::runtime_error("audio features of " + std::to_string(dimension) +
                             " dimensions, the model was trained on " + std::to_string(inputs.mean.size()));
  if (!audio.values.allFinite())
    throw std::runtime_error("audio features with NaN or infinite values: look at the stage before");
  const Eigen::MatrixXd z = (audio.values.rowwise() - inputs.mean).array().rowwise() * inputs.scale.array();
  const int n = inputs.context;
  Eigen::MatrixXd out(frames, dimension * (2 * n + 1));
  for (Eigen::Index t = 0; t < frames; ++t)
    for (int i = -n; i <= n; ++i)
      out.block(t, (i + n) * dimension, 1, dimension) = z.row(std::clamp<Eigen::Index>(t + i, 0, frames - 1));
  return out;
}

StackedTraining stack_training(const Collected<Track>& audio, const Collected<Track>& visual, int context, bool scale) {
  const auto pairs = pair_up(audio, visual);
  Eigen::Index total = 0;
  for (const auto& p : pairs) total += p.frames;
  if (total == 0) throw std::runtime_error("no training frame: is the training selection empty?");

  StackedTraining out;
  out.inputs.context = context;
  const auto dimension = pairs[0].audio->dimension();
  out.inputs.mean = Eigen::RowVectorXd::Zero(dimension);
  out.inputs.scale = Eigen::RowVectorXd::Ones(dimension);
  if (scale) z_score(out.inputs, pairs, total);

  out.audio.resize(total, dimension * (2 * context + 1));
  out.visual.resize(total, pairs[0].visual->dimension());
  Eigen::Index at = 0;
  for (const auto& p : pairs) {
    const Eigen::MatrixXd audio_rows = stacked(out.inputs, *p.audio);
    const Eigen::Index first = at;
    for (Eigen::Index t = 0; t < p.frames; ++t) {
      if (p.visual->is_lost(t)) continue;
      out.audio.row(at) = audio_rows.row(t);
      out.visual.row(at++) = p.visual->values.row(t);
    }
    if (at > first) out.lengths.push_back(at - first);
  }
  out.audio.conservativeResize(at, Eigen::NoChange);
  out.visual.conservativeResize(at, Eigen::NoChange);
  if (at == 0) throw std::runtime_error("no training frame that is not lost");
  return out;
}

}  // namespace talkgraph
