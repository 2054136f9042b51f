#include "nodes/speech/join.h"

#include <cmath>
#include <stdexcept>

namespace talkgraph {

Track Join::operator()(const Track& a, const Track* other) const {
  if (!other) return a;
  const Track& b = *other;
  if (a.rate != b.rate || std::abs(a.start - b.start) > 1e-6)
    throw std::runtime_error(
        "tracks at " + a.rate.str() + " and " + b.rate.str() +
        " frames per second that do not start together cannot be joined: bring both to one rate first");
  if (std::abs(a.frames() - b.frames()) > 2)
    throw std::runtime_error("tracks of " + std::to_string(a.frames()) + " and " + std::to_string(b.frames()) +
                             " frames cannot be joined");
  const auto frames = std::min(a.frames(), b.frames());
  Track out;
  out.rate = a.rate;
  out.start = a.start;
  out.values.resize(frames, a.dimension() + b.dimension());
  out.values << a.values.topRows(frames), b.values.topRows(frames);
  if (!a.names.empty() && !b.names.empty()) {
    out.names = a.names;
    out.names.insert(out.names.end(), b.names.begin(), b.names.end());
  }
  return out;
}

void describe(Description<Join>& d) {
  d.type("speech.join").summary("two tracks side by side");
  d.input("a", "the first dimensions")
      .input("b", "of the same rate, the dimensions behind them; without it there is a alone")
      .output("track", "both, as long as the shorter");
}

}  // namespace talkgraph
