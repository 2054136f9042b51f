#pragma once

#include <memory>

#include "nodes/types/face_track.h"
#include "nodes/types/prototypes.h"

namespace talkgraph::bench {

/// OpenCV's active appearance model, to compare with. It scales pictures to its own size, so that its starts are
/// given as poses of its mean shape.
class Facemark {
 public:
  explicit Facemark(const Prototypes& faces);
  ~Facemark();
  const Shape& mean() const { return mean_; }
  Shape fit(const cv::Mat& picture, const Pose& start);

 private:
  struct Peer;
  std::unique_ptr<Peer> peer_;
  Shape mean_;
};

}  // namespace talkgraph::bench
