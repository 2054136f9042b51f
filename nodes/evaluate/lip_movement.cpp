#include "nodes/evaluate/lip_movement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/evaluate/derivative_warping.h"
#include "nodes/evaluate/lips.h"
#include "nodes/evaluate/mean.h"
#include "nodes/evaluate/score.h"
#include "nodes/types/paired.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

/// Mean over the frames that have landmarks.
double true_length(const LandmarkTrack& truth, const std::vector<std::string>& unit) {
  if (unit.empty()) return 1;
  if (unit.size() != 2) throw std::runtime_error(fmt::format("a unit needs two points, not {}", unit.size()));
  double sum = 0, count = 0;
  for (const double d : point_distance(truth, unit[0], unit[1]))
    if (std::isfinite(d)) sum += d, ++count;
  if (count > 0 && sum == 0)
    throw std::runtime_error(fmt::format("{} and {} are one point in every frame", unit[0], unit[1]));
  return sum / count;
}

std::vector<int> lip_points(const LandmarkTrack& truth, const LandmarkTrack& predicted,
                            const std::vector<std::string>& groups) {
  const PointScheme scheme = scheme_of(truth), other = scheme_of(predicted);
  if (other.name != scheme.name || other.points() != scheme.points())
    throw std::runtime_error(
        fmt::format("true landmarks are of scheme \"{}\", synthesised ones of \"{}\"", scheme.name, other.name));
  std::vector<int> points;
  for (const auto& group : groups)
    for (const int point : scheme.named(group)) points.push_back(point);
  if (points.empty()) throw std::runtime_error("no group or point of the lips is named");
  return points;
}

/// The lips in one frame.
struct Lips {
  Shape truth, said;
  bool there = false, speech = false;
};

std::vector<Lips> lips_of(const LandmarkTrack& truth, const LandmarkTrack& predicted, const Mask& speech,
                          const std::vector<int>& points) {
  std::vector<Lips> all(std::min({truth.frames.size(), predicted.frames.size(), speech.frames.size()}));
  for (std::size_t t = 0; t < all.size(); ++t) {
    Lips& lips = all[t];
    lips = {truth.frames[t](points, Eigen::all), predicted.frames[t](points, Eigen::all)};
    lips.there = lips.truth.allFinite() && lips.said.allFinite();
    lips.speech = speech.frames[t] != 0;
  }
  return all;
}

Eigen::VectorXd lengths(const Shape& vectors) { return vectors.rowwise().norm(); }

void score_distances(const std::vector<Lips>& frames, double unit, Scores& scores) {
  Mean distance, vertex, velocity, silent;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const Lips& now = frames[t];
    if (!now.there) continue;
    if (now.speech) {
      const Eigen::VectorXd error = lengths(now.said - now.truth);
      distance.add(error.mean());
      vertex.add(error.maxCoeff());
    }
    if (t == 0 || !frames[t - 1].there || frames[t - 1].speech != now.speech) continue;
    const Shape move = now.said - frames[t - 1].said;
    if (now.speech)
      velocity.add(lengths(move - (now.truth - frames[t - 1].truth)).mean());
    else
      silent.add(lengths(move).mean());
  }
  distance.store(scores, "lmd", unit);
  velocity.store(scores, "lmvd", unit);
  vertex.store(scores, "lve", unit);
  silent.store(scores, "silent", unit);
}

}  // namespace

std::optional<Scores> LipMovement::operator()(const LandmarkTrack& truth, const LandmarkTrack& predicted,
                                              const Mask& speech) const {
  const auto true_frames = std::ssize(truth.frames);
  common_frames("the sequence", true_frames, "true frames", std::ssize(predicted.frames), "synthesised ones");
  common_frames("the sequence", true_frames, "true frames", std::ssize(speech.frames), "marks of speech");
  if (truth.frames.empty() || predicted.frames.empty()) return {};
  const auto frames = lips_of(truth, predicted, speech, lip_points(truth, predicted, points));
  const double length = true_length(truth, unit);
  Scores scores;
  score_distances(frames, length, scores);

  std::vector<Eigen::Index> there, said;  // from the first frame of speech that counts to the last; of speech
  for (std::size_t t = 0; t < frames.size(); ++t) {
    if (!frames[t].there) continue;
    if (frames[t].speech) said.push_back(static_cast<Eigen::Index>(t));
    if (!said.empty()) there.push_back(static_cast<Eigen::Index>(t));
  }
  if (said.empty()) return scores.values.empty() ? std::nullopt : std::optional(scores);
  there.resize(static_cast<std::size_t>(std::find(there.begin(), there.end(), said.back()) - there.begin()) + 1);
  const Eigen::VectorXd truly = point_distance(truth, upper, lower), gap = point_distance(predicted, upper, lower);
  scores.values["ddtw"] = derivative_warping(truly(there), gap(there), window) / length;
  scores.values["gap_range"] = range_of_motion(truly(said), gap(said));
  return scores;
}

void describe(Description<LipMovement>& d) {
  d.type("evaluate.lip_movement").summary("distances of synthesised lips from the true ones, and how they move");
  d.source("Chen et al. 2018; Zhou et al. 2020 (MakeItTalk); Richard et al. 2021 (MeshTalk); Keogh & Pazzani 2001");
  d.input("truth", "landmarks of the recorded face, free of head pose")
      .input("predicted", "of the synthesised face, in the same frame of reference")
      .input("speech", "frames that count")
      .output("scores",
              "lmd: distance of lip points from the true ones, mean over points and frames, px (or `unit`); lmvd: "
              "distance of the velocities of lip points from the true ones, px a frame (or `unit`); lve: largest "
              "distance of a lip point in a frame, mean over frames, px (or `unit`); ddtw: distance of the slopes of "
              "the gap between the lips from the true ones, warped in time, px a frame (or `unit`); gap_range: "
              "standard deviation of the gap between the lips / the true one's, 1 at best; silent: movement of the "
              "lips in frames without speech, px a frame (or `unit`)");
  d.param("points", &LipMovement::points).doc("groups or points of the scheme that are the lips");
  d.param("unit", &LipMovement::unit)
      .doc("two points whose mean distance in the truth is the unit of length; empty: pixels of the landmarks");
  d.param("upper", &LipMovement::upper).doc("point in the middle of the inner upper lip, by its name in the scheme");
  d.param("lower", &LipMovement::lower).doc("point in the middle of the inner lower lip");
  d.param("window", &LipMovement::window)
      .within(0, 1000)
      .unit("frames")
      .doc("how far apart time warping may pair frames");
}

}  // namespace talkgraph
