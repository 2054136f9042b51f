#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "nodes/types/shape.h"

namespace talkgraph::bench {

inline constexpr int drawn_size = 300;    ///< pixels, both ways
inline constexpr int drawn_points = 60;   ///< 17 jaw, 10 brows, 9 nose, 12 eyes, 12 outer lips
inline constexpr double drawn_noise = 5;  ///< standard deviation, grey levels

/// A face to be drawn: what of it moves, how it is lit, and what of its skin changes. Angles in radians; what has no
/// unit is a share, 0 at rest.
struct DrawnFace {
  double x = 150, y = 135, radius = 84;    ///< centre and half width, pixels
  double roll = 0, yaw = 0, pitch = 0;     ///< of the head
  double open = 0.4, wide = 0, lift = 0;   ///< jaw, mouth, its corners
  double brow = 0, frown = 0, lids = 0.7;  ///< brows up and inwards, eyes open
  double gain = 1, offset = 0;             ///< of the camera
  double side = 0, top = 0;                ///< light from one side, from above
  std::vector<double> skin;                ///< strength of each of some smooth patterns
  std::uint64_t seed = 1;                  ///< of the noise and what lies behind the head
};

/// Any of one person's faces.
DrawnFace random_face(std::uint64_t seed);
/// One frame of a clip: the same person speaks and moves.
DrawnFace speaking_face(int frame);

/// 8-bit BGR with noise.
cv::Mat draw(const DrawnFace& face);
/// The true places of the points.
Shape landmarks(const DrawnFace& face);

}  // namespace talkgraph::bench
