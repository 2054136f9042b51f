#include "nodes/yardstick/stacked.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace talkgraph {

Eigen::MatrixXd stacked(const StackedInputs& inputs, const Track& audio) {
  const auto frames = audio.frames(), dimension = audio.dimension();
  if (dimension != inputs.mean.size())
    throw std::runtime_error("audio features of " + std::to_string(dimension) +
                             " dimensions, the model was trained on " + std::to_string(inputs.mean.size()));
  const Eigen::MatrixXd z = (audio.values.rowwise() - inputs.mean).array().rowwise() * inputs.scale.array();
  const int n = inputs.context;
  Eigen::MatrixXd out(frames, dimension * (2 * n + 1));
  for (Eigen::Index t = 0; t < frames; ++t)
    for (int i = -n; i <= n; ++i)
      out.block(t, (i + n) * dimension, 1, dimension) = z.row(std::clamp<Eigen::Index>(t + i, 0, frames - 1));
  return out;
}

StackedTraining stack_training(const Collected<Track>& audio, const Collected<Track>& visual, int context) {
  std::vector<std::pair<Track, Track>> pairs;
  Eigen::Index total = 0;
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const Track* other = visual.find(audio.key(i));
    if (!other) continue;
    if (std::abs(audio[i].frames() - other->frames()) > 2)
      throw std::runtime_error(audio.key(i) + ": " + std::to_string(audio[i].frames()) + " audio frames, " +
                               std::to_string(other->frames()) + " visual frames");
    const auto frames = std::min(audio[i].frames(), other->frames());
    pairs.emplace_back(audio[i], *other);
    pairs.back().first.values.conservativeResize(frames, Eigen::NoChange);
    pairs.back().second.values.conservativeResize(frames, Eigen::NoChange);
    total += frames;
  }
  if (total == 0) throw std::runtime_error("no training frame: is the training selection empty?");

  StackedTraining out;
  out.inputs.context = context;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(pairs[0].first.dimension());
  for (const auto& [a, v] : pairs) sum += a.values.colwise().sum();
  out.inputs.mean = sum / static_cast<double>(total);
  Eigen::RowVectorXd square = Eigen::RowVectorXd::Zero(sum.size());
  for (const auto& [a, v] : pairs) square += (a.values.rowwise() - out.inputs.mean).colwise().squaredNorm();
  const Eigen::ArrayXd deviation = (square.transpose().array() / static_cast<double>(total)).sqrt();
  out.inputs.scale = (deviation > 1e-12).select(1 / deviation.max(1e-300), 0.0).matrix().transpose();

  out.audio.resize(total, sum.size() * (2 * context + 1));
  out.visual.resize(total, pairs[0].second.dimension());
  Eigen::Index at = 0;
  for (const auto& [a, v] : pairs) {
    out.audio.middleRows(at, a.frames()) = stacked(out.inputs, a);
    out.visual.middleRows(at, a.frames()) = v.values;
    at += a.frames();
  }
  return out;
}

}  // namespace talkgraph
