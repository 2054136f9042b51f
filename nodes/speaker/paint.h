#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace talkgraph::face {

/// Pixels of the painting per unit of the canvas.
inline constexpr int paint_scale = 2;
/// Pixels of mouth and eyes per unit.
inline constexpr int part_scale = 4;

/// The speaker at rest, lips and lids closed, with shoulders and background:
/// 8-bit BGR. The same seed gives the same picture.
cv::Mat paint_portrait(std::uint64_t seed);

/// Teeth and tongue, 8-bit BGRA at part_scale; transparent around them.
cv::Mat paint_upper_teeth();
cv::Mat paint_lower_teeth();
cv::Mat paint_tongue(std::uint64_t seed);
/// White of the eye, and iris with pupil, 8-bit BGRA at part_scale.
cv::Mat paint_eyeball(std::uint64_t seed);
cv::Mat paint_iris(std::uint64_t seed);

}  // namespace talkgraph::face
