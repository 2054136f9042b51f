#pragma once

#include <opencv2/core.hpp>

#include "nodes/types/appearance_model.h"

namespace talkgraph {

/// Writes into `map` (32-bit, two channels), for every pixel inside the
/// triangles of `to`, the position that it comes from in `from`.
void draw_map(cv::Mat& map, const Shape& to, const Shape& from, const Triangles& triangles);

/// Draws the triangles `from` of `texture` (8-bit, four channels, the fourth ignored) as the triangles `to` of an 8-bit
/// BGR picture, bilinear. Neither side of the texture may exceed 16000 pixels.
void draw_triangles(cv::Mat& picture, const Shape& to, const cv::Mat& texture, const Shape& from,
                    const Triangles& triangles);

/// Draws a texture of grey levels in the triangles of `shape` on an 8-bit BGR picture, bilinear, without what lies
/// beyond the face's edge; gives the mask of what was drawn.
cv::Mat draw_texture(const AppearanceModel& model, const Eigen::VectorXf& texture, const Shape& shape,
                     cv::Mat& picture);

/// For a picture of `size`: every pixel maps to itself.
cv::Mat identity_map(cv::Size size);
/// For a picture of `size`: every pixel maps outside of any picture.
cv::Mat empty_map(cv::Size size);

/// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double x);

}  // namespace talkgraph
