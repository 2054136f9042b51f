#include "nodes/sync/median.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "nodes/sync/video_frames.h"
#include "nodes/types/median.h"

namespace talkgraph {

Track MedianSync::operator()(const Track& track, const Audio* audio) const {
  Track out = unfilled(track, audio, rate);
  const double in_rate = track.rate.value();
  const auto last = static_cast<double>(track.frames() - 1);
  const auto position = [&](double seconds) { return (seconds - track.start) * in_rate; };
  std::vector<double> column;
  for (Eigen::Index n = 0; n < out.frames(); ++n) {
    // A centre on the border, up to rounding, belongs to the later frame.
    double first = std::ceil(position(static_cast<double>(n) / rate.value()) - 1e-9);
    double end = std::ceil(position(static_cast<double>(n + 1) / rate.value()) - 1e-9);
    if (end <= std::max(first, 0.0) || first > last) {
      first = std::clamp(std::round(position(video_time(n, rate))), 0.0, last);
      end = first + 1;
    }
    const auto from = static_cast<Eigen::Index>(std::max(first, 0.0));
    const auto to = static_cast<Eigen::Index>(std::min(end, last + 1));
    for (Eigen::Index d = 0; d < track.dimension(); ++d) {
      column.assign(track.values.col(d).data() + from, track.values.col(d).data() + to);
      out.values(n, d) = median(column);
    }
  }
  return out;
}

void describe(Description<MedianSync>& d) {
  d.type("sync.median")
      .summary("to the video rate by the median of the frames in each video frame")
      .source("Thesis §3.5.1");
  d.input("track", "at a higher rate").input("audio", "gives the exact length").output("track", "at the video rate");
  d.param("rate", &MedianSync::rate).positive().unit("frames/s").doc("video rate");
}

}  // namespace talkgraph
