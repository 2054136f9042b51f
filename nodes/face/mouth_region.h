#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "nodes/types/appearance_model.h"
#include "nodes/types/mouths.h"

namespace talkgraph {

/// Where the mouth lies on a model's finest raster.
struct MouthRegion {
  cv::Rect box;                      ///< of what `share` has
  cv::Mat share;                     ///< raster, 32-bit: 1 inside the points' hull, falling to 0 at the margin
  std::vector<Eigen::Index> pixels;  ///< of the raster's list, those in the box
};

/// `margin` is a share of the mouth's width. Throws std::runtime_error if the
/// model lacks a point or the points span no area.
MouthRegion mouth_region(const AppearanceModel& model, const std::vector<int>& points, double margin);

/// Throws std::runtime_error unless there are as many pictures as parameters, the latter of the model, the former of
/// the region's size.
void check_mouths(const AppearanceModel& model, const MouthRegion& region, const Mouths& mouths);

/// Linear map of appearance parameters c to coordinates in which distance is how
/// far mouths differ: in texture, and in shape by the weight the model gives it.
Eigen::MatrixXd mouth_metric(const AppearanceModel& model, const MouthRegion& region, const std::vector<int>& points);

/// Normalised texture of the region's pixels per unit of c, three rows a pixel.
Eigen::MatrixXf mouth_texture_modes(const AppearanceModel& model, const MouthRegion& region);

}  // namespace talkgraph
