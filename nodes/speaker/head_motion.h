#pragma once

#include <vector>

#include "graph/random.h"
#include "graph/rational.h"

namespace talkgraph {

/// What the head does besides speaking, at one moment; picture of 288 lines.
struct HeadMotion {
  double dx = 0, dy = 0;          ///< shift, pixels
  double roll = 0;                ///< radians, clockwise
  double scale = 1;               ///< nearer or further
  double yaw = 0, pitch = 0;      ///< turn of the face, pixels that the nose moves
  double blink = 0;               ///< 1 lids closed
  double brow = 0;                ///< 1 raised
  double gaze_x = 0, gaze_y = 0;  ///< of the pupils, pixels
};

/// Slow drift of the head, blinks every few seconds and brow movements: none
/// of it follows the speech.
std::vector<HeadMotion> head_motion(std::int64_t frames, Rational rate, Random& random);

}  // namespace talkgraph
