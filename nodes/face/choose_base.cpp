#include "nodes/face/choose_base.h"

#include <fmt/format.h>

#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "nodes/face/base_clip.h"

namespace talkgraph {

BaseClip ChooseBase::operator()(const Collected<Video>& videos, const Collected<FaceTrack>& tracks) const {
  const Video* best_video = nullptr;
  const FaceTrack* best_track = nullptr;
  auto best = std::make_tuple(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < videos.size(); ++i) {
    const auto* track = tracks.find(videos.key(i));
    if (!track || track->shapes.empty() || (!key.empty() && videos.key(i) != key)) continue;
    const auto lost = std::accumulate(track->lost.begin(), track->lost.end(), std::int64_t{0});
    const double residual = std::accumulate(track->residual.begin(), track->residual.end(), 0.0);
    const auto score = std::make_tuple(lost, residual / static_cast<double>(track->residual.size()));
    if (best_video && score >= best) continue;
    best = score;
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
      .version(1)
      .summary("picks the clip to draw synthesised faces upon")
      .source("docs/method.md §2");
  d.input("videos", "clips").input("tracks", "of the clips").output("base", "the clip with the face found in it");
  d.param("key", &ChooseBase::key).doc("of the clip; empty: the best tracked one");
}

}  // namespace talkgraph
