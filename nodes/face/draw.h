#pragma once

#include <opencv2/core.hpp>

#include "nodes/types/appearance_model.h"

namespace talkgraph {

/// Writes into `map` (32-bit, two channels), for every pixel inside the
/// triangles of `to`, the position that it comes from in `from`.
void draw_map(cv::Mat& map, const Shape& to, const Shape& from, const Triangles& triangles);

/// For a picture of `size`: every pixel maps to itself.
cv::Mat identity_map(cv::Size size);
/// For a picture of `size`: every pixel maps outside of any picture.
cv::Mat empty_map(cv::Size size);

/// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double x);

}  // namespace talkgraph
