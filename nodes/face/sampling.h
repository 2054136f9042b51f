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

/// Pixels of a raster that lie side by side in one triangle.
struct Run {
  int x, y, triangle, length;
};
std::vector<Run> runs(const Raster& raster);

/// Writes pixels of three channels one after the other, each as four floats, the last of which the next pixel takes.
class PixelWriter {
 public:
  PixelWriter(float* texture, Eigen::Index pixels) : next_(texture), last_(texture + 3 * (pixels - 1)) {}
  void write(const Eigen::Array4f& pixel) {
    if (next_ != last_)
      Eigen::Map<Eigen::Array4f>{next_} = pixel;
    else
      Eigen::Map<Eigen::Array3f>{next_} = pixel.head<3>();
    next_ += 3;
  }

 private:
  float* next_;
  float* last_;
};

/// Warps the picture inside a shape (picture coordinates) onto a raster:
/// piecewise affine, bilinear, taken from the level of the pyramid that fits
/// the raster's resolution. Outside the picture its border pixels are repeated.
class Sampler {
 public:
  Sampler(const Raster& raster, const Triangles& triangles);
  void operator()(Pyramid& pyramid, const Shape& shape, Eigen::VectorXf& texture) const;

 private:
  Shape points_;
  double spread_;
  Triangles triangles_;
  std::vector<Run> runs_;
  Eigen::Index size_;
};

/// The same, once.
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
