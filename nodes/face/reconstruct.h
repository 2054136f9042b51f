#pragma once

#include <opencv2/core.hpp>

#include "nodes/types/appearance_model.h"
#include "nodes/types/prototypes.h"

namespace talkgraph {

/// A face with known landmarks as the model sees it, and what comes back.
struct Reconstruction {
  Eigen::VectorXd aligned;  ///< 2n, its shape in the model frame
  Eigen::VectorXf texture;  ///< 3P, normalised
  Eigen::VectorXd reduced;  ///< W_s b_s and b_g, before the last reduction
  Eigen::VectorXd c;
  Shape shape;           ///< the shape of c, at the face's place in the picture
  cv::Mat picture;       ///< the given picture with the face of c drawn upon it
  double landmarks;      ///< root mean square distance to the given ones, pixels of the picture
  double texture_error;  ///< root mean square, grey levels, over the raster
  double psnr;           ///< of the face drawn upon the picture, over the pixels drawn, decibels; at most 100
};

/// Projects a picture with its landmarks on the model's modes and draws what
/// they keep (Eqn 3.18): no fit is made. Throws std::runtime_error if the
/// number of landmarks is not the model's or one is not a number.
Reconstruction reconstruct(const AppearanceModel& model, const cv::Mat& picture, const Shape& landmarks);

}  // namespace talkgraph
