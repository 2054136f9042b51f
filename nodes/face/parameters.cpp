#include "nodes/face/parameters.h"

namespace talkgraph {

Track FaceParameters::operator()(const FaceTrack& track) const { return track.parameters; }

void describe(Description<FaceParameters>& d) {
  d.type("face.parameters")
      .version(1)
      .summary("the appearance parameters of a tracked clip")
      .source("docs/method.md §2");
  d.input("track").output("parameters", "T × modes, first frame centred at half a frame");
}

}  // namespace talkgraph
