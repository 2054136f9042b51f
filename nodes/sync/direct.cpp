#include "nodes/sync/direct.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "nodes/sync/video_frames.h"

namespace talkgraph {

Track DirectSync::operator()(const Track& track, const Audio* audio) const {
  check_finite(track);
  if (track.rate != rate)
    throw std::runtime_error(
        fmt::format("a track at {} frames per second was not computed at the video rate of {}: frame the sound at that "
                    "rate, or use sync.polyphase",
                    track.rate.str(), rate.str()));
  if (std::abs(track.start - video_time(0, rate)) > 1e-6)
    throw std::runtime_error(
        fmt::format("the first frame is centred on {:.6f} s, that of the video on {:.6f} s: frame the sound centred",
                    track.start, video_time(0, rate)));
  const auto frames = video_frames(track, audio, rate);
  if (std::abs(frames - track.frames()) > 1)
    throw std::runtime_error(fmt::format("a track of {} frames beside a video of {}", track.frames(), frames));
  Track out = track;
  out.values.conservativeResize(frames, Eigen::NoChange);
  if (frames > track.frames()) out.values.row(track.frames()) = track.values.row(track.frames() - 1);
  return out;
}

void describe(Description<DirectSync>& d) {
  d.type("sync.direct").summary("checks that a track was computed at the video rate").source("Thesis §3.5.1");
  d.input("track", "on the frames of the video").input("audio", "gives the exact length").output("track", "the same");
  d.param("rate", &DirectSync::rate).positive().unit("frames/s").doc("video rate");
}

}  // namespace talkgraph
