#include "nodes/speech/deltas.h"

#include <algorithm>

namespace talkgraph {

Track Deltas::operator()(const Track& track) const {
  Track out = track;
  out.values.setZero();
  const auto last = track.frames() - 1;
  double squares = 0;
  for (int n = 1; n <= window; ++n) {
    squares += n * n;
    for (Eigen::Index t = 0; t <= last; ++t)
      out.values.row(t) +=
          n * (track.values.row(std::min(t + n, last)) - track.values.row(std::max<Eigen::Index>(t - n, 0)));
  }
  out.values /= 2 * squares;
  for (auto& name : out.names) name = "delta " + name;
  return out;
}

void describe(Description<Deltas>& d) {
  d.type("speech.deltas").summary("slope of each dimension").source("HTK Book, delta coefficients");
  d.input("track", "T x D").output("track", "T x D, per frame");
  d.param("window", &Deltas::window).within(1, 100).unit("frames").doc("on each side");
}

}  // namespace talkgraph
