#include "nodes/face/landmarks.h"

namespace talkgraph {

LandmarkTrack FaceLandmarks::operator()(const FaceTrack& track, const AppearanceModel* model) const {
  return {track.shapes, track.parameters.rate, model ? model->scheme : ""};
}

void describe(Description<FaceLandmarks>& d) {
  d.type("face.landmarks").version(2).summary("the landmarks that tracking found").source("docs/method.md §2");
  d.input("track", "of a clip").input("model", "that was followed: tells the scheme of the points");
  d.output("landmarks", "picture coordinates");
}

}  // namespace talkgraph
