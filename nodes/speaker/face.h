#pragma once

#include <array>
#include <vector>

#include "nodes/speaker/articulation.h"
#include "nodes/speaker/head_motion.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// The built-in speaker's face as geometry. It is painted once, at rest with
/// closed lips and lids, on a canvas of 360 × 288 units; a moment moves every
/// point of it. Lids and lips are cuts in the canvas, which open as gaps.
namespace face {

using Point = Eigen::Vector2d;

inline constexpr double canvas_width = 360, canvas_height = 288;
inline constexpr double centre_x = 180;
inline constexpr double mouth_y = 204;
inline constexpr double mouth_half_width = 27;
inline constexpr double eye_distance = 31.5;  ///< from the middle line
inline constexpr double eye_half_width = 15.5;

/// Parts of the canvas between the cuts, from the top: down to the lids, down
/// to the lips, down to the frame.
enum class Part { brow, cheek, chin };

/// The cut along both lids, and on between and beyond them.
double lid_line(double x);
/// The cut along the lips, and on beyond the corners.
double lip_line(double x);
/// Half the width of the face below the ears at a height, 0 below the chin.
double half_width(double y);
inline constexpr double jaw_top = 128, chin_bottom = 248;

/// All that moves the face at one moment.
struct Moment {
  Articulators mouth;
  HeadMotion head;
};

/// What a moment amounts to: how far each movement goes.
inline constexpr std::size_t movements = 13;
struct Movement {
  std::array<double, movements> amounts;
  double dx, dy, cosine, sine;  ///< of the whole head
  double jaw_drop;              ///< units
  double gap;                   ///< between the lips in the middle, units
};
Movement movement(const Moment& moment);

/// A point of the canvas with what moves it, worked out once.
struct Bound {
  Point rest;
  std::array<Point, movements> shifts;
  double head;  ///< 1 moves with the head, 0 stays
};
Bound bind(const Point& rest, Part part);

/// Where a point goes.
Point place(const Bound& point, const Movement& movement);

/// The 68 points of the iBUG scheme on the canvas.
std::vector<Bound> landmarks();

}  // namespace face
}  // namespace talkgraph
