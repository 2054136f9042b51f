#include "nodes/speech/stack.h"

#include <fmt/format.h>

#include <algorithm>

namespace talkgraph {

Track Stack::operator()(const Track& track) const {
  const auto frames = track.frames(), dimension = track.dimension();
  Track out;
  out.rate = track.rate;
  out.start = track.start;
  out.values.resize(frames, dimension * (before + 1 + after));
  for (Eigen::Index t = 0; t < frames; ++t)
    for (int n = -before; n <= after; ++n)
      out.values.block(t, (n + before) * dimension, 1, dimension) =
          track.values.row(std::clamp<Eigen::Index>(t + n, 0, frames - 1));
  for (int n = -before; n <= after; ++n)
    for (const auto& name : track.names) out.names.push_back(n == 0 ? name : fmt::format("{} at {:+}", name, n));
  for (Eigen::Index t = 0; t < frames; ++t)
    if (std::any_of(track.lost.begin(), track.lost.end(),
                    [&](auto lost) { return lost >= t - before && lost <= t + after; }))
      out.lost.push_back(t);
  return out;
}

void describe(Description<Stack>& d) {
  d.type("speech.stack").version(2).summary("each frame with its neighbours");
  d.input("track", "T x D").output("track", "T x D (before + 1 + after)");
  d.param("before", &Stack::before).within(0, 100).unit("frames").doc("neighbours in front");
  d.param("after", &Stack::after).within(0, 100).unit("frames").doc("neighbours behind");
}

}  // namespace talkgraph
