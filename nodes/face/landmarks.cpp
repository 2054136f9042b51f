#include "nodes/face/landmarks.h"

namespace talkgraph {

LandmarkTrack FaceLandmarks::operator()(const FaceTrack& track) const {
  return {track.shapes, track.parameters.rate, ""};
}

void describe(Description<FaceLandmarks>& d) {
  d.type("face.landmarks").version(1).summary("the landmarks that tracking found").source("docs/method.md §2");
  d.input("track", "of a clip").output("landmarks", "picture coordinates");
}

}  // namespace talkgraph
