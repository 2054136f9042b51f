#include "nodes/face/parameters.h"

namespace talkgraph {

Track FaceParameters::operator()(const FaceTrack& track) const {
  Track parameters = track.parameters;
  for (std::size_t t = 0; t < track.lost.size(); ++t)
    if (track.lost[t]) parameters.lost.push_back(static_cast<std::int64_t>(t));
  return parameters;
}

void describe(Description<FaceParameters>& d) {
  d.type("face.parameters")
      .version(1)
      .summary("the appearance parameters of a tracked clip")
      .source("docs/method.md §2");
  d.input("track", "of a clip").output("parameters", "T × modes, first frame centred at half a frame");
}

}  // namespace talkgraph
