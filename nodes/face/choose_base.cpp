#include "nodes/face/choose_base.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "nodes/face/base_clip.h"

namespace talkgraph {
namespace {

/// Mean residual of the frames in which the face was found, as a share of the contrast there.
double relative_residual(const FaceTrack& track) {
  double sum = 0, found = 0;
  for (std::size_t t = 0; t < track.lost.size(); ++t)
    if (!track.lost[t] && track.gain[t] > 0) sum += track.residual[t] / track.gain[t], ++found;
  return found > 0 ? sum / found : std::numeric_limits<double>::infinity();
}

double good_seconds(const Video& video, const FaceTrack& track) {
  return static_cast<double>(longest_good_run(track).length) / video.source->rate().value();
}

}  // namespace

BaseClip ChooseBase::operator()(const Collected<Video>& videos, const Collected<FaceTrack>& tracks) const {
  const Video* best_video = nullptr;
  const FaceTrack* best_track = nullptr;
  std::pair<double, double> best;
  for (std::size_t i = 0; i < videos.size(); ++i) {
    const auto* track = tracks.find(videos.key(i));
    if (!track || track->shapes.empty() || (!key.empty() && videos.key(i) != key)) continue;
    const std::pair missing_and_residual(std::max(0.0, length - good_seconds(videos[i], *track)),
                                         relative_residual(*track));
    if (best_video && missing_and_residual >= best) continue;
    best = missing_and_residual;
    best_video = &videos[i];
    best_track = track;
  }
  if (!best_video)
    throw std::runtime_error(key.empty() ? "there is no tracked clip to draw upon"
                                         : fmt::format("no tracked clip is called \"{}\"", key));
  return MakeBaseClip{}(*best_video, *best_track);
}

void describe(Description<ChooseBase>& d) {
  d.type("face.choose_base")
      .stored()
      .version(2)
      .summary("picks the clip to draw synthesised faces upon")
      .source("docs/method.md §2");
  d.input("videos", "clips").input("tracks", "of the clips").output("base", "the clip with the face found in it");
  d.param("key", &ChooseBase::key).doc("of the clip; empty: the best fitted one that is long enough");
  d.param("length", &ChooseBase::length)
      .at_least(0)
      .unit("s")
      .doc("long enough: the face is found in every frame for so long; if in no clip, the longest is taken");
}

}  // namespace talkgraph
