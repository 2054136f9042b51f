#include "nodes/evaluate/tracking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/types/paired.h"

namespace talkgraph {
namespace {

void score_confidence(const FaceTrack& track, Scores& scores) {
  double sum = 0, least = 1, found = 0;
  for (std::size_t t = 0; t < track.lost.size(); ++t) {
    if (track.lost[t]) continue;
    sum += track.confidence[t];
    least = std::min(least, track.confidence[t]);
    ++found;
  }
  const auto frames = static_cast<double>(track.lost.size());
  scores.values["frames"] = frames;
  scores.values["lost"] = frames - found;
  if (found == 0) return;
  scores.values["confidence"] = sum / found;
  scores.values["least_confidence"] = least;
}

void score_landmarks(const FaceTrack& track, const LandmarkTrack& given, Scores& scores) {
  const auto frames = common_frames("the sequence", std::ssize(track.shapes), "tracked frames",
                                    std::ssize(given.frames), "frames with given landmarks");
  double sum = 0, worst = 0, counted = 0;
  for (std::size_t t = 0; t < static_cast<std::size_t>(frames); ++t) {
    const Shape &found = track.shapes[t], &wanted = given.frames[t];
    if (found.rows() != wanted.rows())
      throw std::runtime_error(
          fmt::format("frame {}: {} landmarks are given, {} were tracked", t, wanted.rows(), found.rows()));
    if (track.lost[t] || !wanted.allFinite()) continue;
    const double square = (found - wanted).rowwise().squaredNorm().mean();
    sum += square;
    worst = std::max(worst, std::sqrt(square));
    ++counted;
  }
  if (counted == 0) return;
  scores.values["rms"] = std::sqrt(sum / counted);
  scores.values["worst"] = worst;
}

}  // namespace

Scores ScoreTracking::operator()(const FaceTrack& track, const LandmarkTrack* given) const {
  Scores scores;
  score_confidence(track, scores);
  if (!given) return scores;
  score_landmarks(track, *given, scores);
  return scores;
}

void describe(Description<ScoreTracking>& d) {
  d.type("evaluate.tracking")
      .version(1)
      .summary("how a face was followed: lost frames, confidence, distance from given landmarks")
      .source("docs/method.md §2");
  d.input("track", "of a clip")
      .input("given", "landmarks of the clip")
      .output("scores", "frames, lost, confidence, least_confidence, rms, worst");
}

}  // namespace talkgraph
