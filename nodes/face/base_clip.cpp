#include "nodes/face/base_clip.h"

#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {

GoodRun longest_good_run(const FaceTrack& track) {
  GoodRun best, now;
  for (std::size_t t = 0; t < track.lost.size(); ++t) {
    now = track.lost[t] ? GoodRun{static_cast<std::int64_t>(t) + 1, 0} : GoodRun{now.first, now.length + 1};
    if (now.length > best.length) best = now;
  }
  return best;
}

BaseClip MakeBaseClip::operator()(const Video& video, const FaceTrack& track) const {
  if (video.source->frames() != static_cast<std::int64_t>(track.shapes.size()))
    throw std::runtime_error(fmt::format("{} has {} frames, its face track has {}", video.source->name(),
                                         video.source->frames(), track.shapes.size()));
  return {video, track};
}

void describe(Description<MakeBaseClip>& d) {
  d.type("face.base_clip")
      .version(1)
      .summary("a tracked clip as the base to draw a face upon")
      .source("docs/method.md §2");
  d.input("video", "the clip").input("track", "of the clip").output("base", "the clip with the face found in it");
}

}  // namespace talkgraph
