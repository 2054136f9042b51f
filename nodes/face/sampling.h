#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "nodes/types/appearance_model.h"

namespace talkgraph {

/// A picture at full, half, quarter ... size, 32-bit float BGR. Position (x, y)
/// of the picture is (x, y) / 2^k of level k.
class Pyramid {
 public:
  /// Levels down to a picture of a few pixels, made when first asked for.
  explicit Pyramid(const cv::Mat& picture);
  const cv::Mat& level(int k);
  /// The level whose pixels come closest to `pixels` picture pixels each.
  int level_for(double pixels);

 private:
  std::vector<cv::Mat> levels_;
};

/// Warps the picture inside a shape (picture coordinates) onto the raster:
/// piecewise affine, bilinear, taken from the level of the pyramid that fits
/// the raster's resolution. Outside the picture its border pixels are repeated.
void sample(Pyramid& pyramid, const Shape& shape, const Triangles& triangles, const Raster& raster,
            Eigen::VectorXf& texture);

/// A texture as a picture of the raster; `fill` where there is no face.
cv::Mat raster_picture(const Raster& raster, const Eigen::VectorXf& texture, cv::Scalar fill = {});

/// Mean 0 and norm 1 (Eqn 3.13); gives what was taken out. A flat texture has gain 0 and becomes 0.
struct Photometry {
  double offset = 0, gain = 0;
};
Photometry normalise(Eigen::VectorXf& texture);

}  // namespace talkgraph
