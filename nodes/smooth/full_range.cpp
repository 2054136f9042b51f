#include "nodes/smooth/full_range.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talkgraph {
namespace {

std::vector<Eigen::Index> marked(const Mask& mask, Eigen::Index frames) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index t = 0; t < std::min(frames, static_cast<Eigen::Index>(mask.frames.size())); ++t)
    if (mask.frames[static_cast<std::size_t>(t)]) rows.push_back(t);
  return rows;
}

/// 1 in these rows, falling to 0 at the (fade + 1)-th frame from them.
Eigen::VectorXd faded(const std::vector<Eigen::Index>& rows, Eigen::Index frames, int fade) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(frames);
  for (const auto row : rows)
    for (Eigen::Index t = std::max<Eigen::Index>(0, row - fade); t <= std::min(frames - 1, row + fade); ++t)
      weight[t] = std::max(weight[t], 1 - static_cast<double>(std::abs(t - row)) / (fade + 1));
  return weight;
}

}  // namespace

Track FullRange::operator()(const Track& track, const Track& variance, const Mask& speech) const {
  if (track.dimension() != variance.dimension() || track.frames() != variance.frames())
    throw std::runtime_error("the variance is of another size than the track: both must be of one prediction");
  if (std::abs(static_cast<Eigen::Index>(speech.frames.size()) - track.frames()) > 2)
    throw std::runtime_error("speech is marked for " + std::to_string(speech.frames.size()) + " frames of " +
                             std::to_string(track.frames()));
  if (!track.values.allFinite() || !variance.values.allFinite() || (variance.values.array() < 0).any())
    throw std::runtime_error("NaN or infinite values, or variances below 0: look at the stage before");
  Track out = track;
  const auto rows = marked(speech, track.frames());
  if (rows.empty()) return out;
  const Eigen::VectorXd weight = faded(rows, track.frames(), fade);
  for (Eigen::Index d = 0; d < track.dimension(); ++d) {
    const Eigen::VectorXd said = track.values.col(d)(rows);
    const double mean = said.mean(), explained = (said.array() - mean).square().mean();
    if (explained <= 1e-20 * said.squaredNorm()) continue;
    const double missing = variance.values.col(d)(rows).mean();
    const double gain = std::pow(1 + missing / explained, strength / 2);
    out.values.col(d).array() += (gain - 1) * weight.array() * (track.values.col(d).array() - mean);
  }
  return out;
}

void describe(Description<FullRange>& d) {
  d.type("smooth.full_range")
      .summary("gives the mean of a process the range of motion that its variance says it lacks");
  d.input("track", "mean of a process")
      .input("variance", "its variance")
      .input("speech", "frames that move")
      .output("track", "the same, moving more");
  d.param("strength", &FullRange::strength).within(0, 1).doc("0: nothing is done; 1: all that is lacking");
  d.param("fade", &FullRange::fade).at_least(0).unit("frames").doc("over which pauses begin and end");
}

}  // namespace talkgraph
