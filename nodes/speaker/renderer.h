#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "nodes/speaker/face.h"

namespace talkgraph::face {

/// Pixel size of pictures of a height: 5/4 as wide, even.
cv::Size picture_size(int height);

/// Landmarks of a moment in pixels of a picture of that height, in steps of
/// 1/64 so that they are the same on every machine.
Shape picture_landmarks(const std::vector<Bound>& points, const Moment& moment, int height);

/// Draws the face. Making one paints it, which takes a second or so; drawing
/// takes some milliseconds and may be done from several threads.
class Renderer {
 public:
  Renderer(int height, std::uint64_t seed);
  ~Renderer();

  /// 8-bit BGR; `grain` chooses the noise of the camera.
  cv::Mat draw(const Moment& moment, std::uint64_t grain) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace talkgraph::face
