#include "nodes/sync/together.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/types/paired.h"

namespace talkgraph {
TrackPair Together::operator()(const Track& a, const Track& b, Context& context) const {
  if (!(a.rate == b.rate))
    throw std::runtime_error(
        fmt::format("the tracks are of {} and {} frames a second: bring them to one rate", a.rate.str(), b.rate.str()));
  const auto frames = common_frames(context.item, a.frames(), "frames in \"a\"", b.frames(), "in \"b\"");
  return {beginning(a, frames), beginning(b, frames)};
}

void describe(Description<Together>& d) {
  d.type("sync.together").summary("two tracks of one utterance, cut to the frames that both have");
  d.input("a", "a track").input("b", "of the same rate, up to two frames longer or shorter");
  d.output("a", &TrackPair::a, "as long as b").output("b", &TrackPair::b, "as long as a");
}

}  // namespace talkgraph
