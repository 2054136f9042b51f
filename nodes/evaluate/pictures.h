#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/shape.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// How near a drawn face comes to the recorded one, in the pictures of one clip:
///   psnr_face, psnr_mouth   peak signal to noise ratio inside the hull of all landmarks, and of the mouth's, decibels
///   ssim_face, ssim_mouth   structural similarity of the grey levels there (Wang et al. 2004; Gaussian of 1.5 pixels)
///   sharpness  energy of the grey levels' gradient inside the lips, drawn over recorded, frames with parted lips
///   jumps      root mean square change from frame to frame in the mouth, drawn over recorded
///   seam       root mean square step across the face's edge (the hull's outline), drawn over recorded
///   left_out   frames that do not count: damaged ones, those without landmarks or with all of them outside the picture
/// A ratio is NaN where nothing is recorded to compare with, the PSNR of equal pictures 100. Nothing is given without a
/// frame that counts. Throws std::runtime_error if the videos differ in size, lengths differ by more than two frames,
/// or a point is missing.
struct ComparePictures {
  std::vector<int> mouth;  ///< around the lips; empty: the scheme's outer lips
  std::vector<int> inner;  ///< between the lips; empty: the scheme's inner lips
  double parted = 0.12;    ///< least height of the inner lips' hull that counts as parted, share of its width

  std::optional<Scores> operator()(const Video& recorded, const Video& drawn, const LandmarkTrack& landmarks) const;
};
void describe(Description<ComparePictures>& d);

}  // namespace talkgraph
