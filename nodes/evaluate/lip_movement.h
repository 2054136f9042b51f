#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/shape.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// How near synthesised lips come to the true ones, both in one frame of reference, free of head pose. Lengths are
/// pixels of the given landmarks, or shares of a distance (`unit`). On frames that `speech` marks:
///   lmd    landmark distance: mean over frames and lip points of |p̂ − p| (Chen et al. 2018)
///   lmvd   landmark velocity distance: the same of the changes from frame to frame, a frame (Zhou et al. 2020)
///   lve    lip vertex error: largest |p̂ − p| of the lip points, mean over frames (Richard et al. 2021)
///   ddtw   derivative dynamic time warping of the gap between the inner lips, from the first marked frame to the last
///          (derivative_warping.h), a frame
///   gap_range  range of motion of that gap: standard deviation, synthesised / true
/// and on all others:
///   silent  mean over lip points of how far the synthesised ones move from one such frame to the next
/// Frames that either lacks do not count. A score is left out where no frame counts; gap_range is NaN if the true gap
/// does not vary. Throws std::runtime_error if lengths differ by more than two frames, the schemes differ or lack a
/// point, or the distance of `unit` is nought.
struct LipMovement {
  std::vector<std::string> points = {"outer_lips", "inner_lips"};
  std::vector<std::string> unit = {};  ///< two points whose mean true distance lengths are divided by; empty: pixels
  std::string upper = "inner_top";     ///< point in the middle of the inner upper lip, by its name in the scheme
  std::string lower = "inner_bottom";  ///< of the inner lower lip
  int window = 10;                     ///< of warping, frames

  std::optional<Scores> operator()(const LandmarkTrack& truth, const LandmarkTrack& predicted,
                                   const Mask& speech) const;
};
void describe(Description<LipMovement>& d);

}  // namespace talkgraph
