#include "nodes/face/landmarks.h"

#include <limits>

namespace talkgraph {

LandmarkTrack FaceLandmarks::operator()(const FaceTrack& track, const AppearanceModel* model) const {
  LandmarkTrack out{track.shapes, track.parameters.rate, model ? model->scheme : ""};
  for (std::size_t t = 0; t < out.frames.size(); ++t)
    if (track.lost[t]) out.frames[t].setConstant(std::numeric_limits<double>::quiet_NaN());
  return out;
}

void describe(Description<FaceLandmarks>& d) {
  d.type("face.landmarks").version(3).summary("the landmarks that tracking found").source("docs/method.md §2");
  d.input("track", "of a clip").input("model", "that was followed: tells the scheme of the points");
  d.output("landmarks", "picture coordinates; none where the face was lost");
}

}  // namespace talkgraph
