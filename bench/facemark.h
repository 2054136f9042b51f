#pragma once

#include <memory>

#include "nodes/types/face_track.h"
#include "nodes/types/prototypes.h"

namespace talkgraph::bench {

/// Another program's model of faces, to compare with.
class FitPeer {
 public:
  virtual ~FitPeer() = default;
  /// In a frame of its own.
  virtual Shape mean() const = 0;
  /// The points found from a pose of the mean shape.
  virtual Shape fit(const cv::Mat& picture, const Pose& start) = 0;
};

/// OpenCV's FacemarkAAM built from the faces; null where talkgraph was built without its library.
std::unique_ptr<FitPeer> facemark(const Prototypes& faces);

}  // namespace talkgraph::bench
