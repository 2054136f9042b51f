#pragma once

#include "graph/description.h"
#include "nodes/types/mouth_space.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Learns from landmarks of the training clips how mouths are measured: the mean of the points of `reference`
/// (generalised Procrustes, of average width), and the principal components of the points of `mouth`, aligned by the
/// others, each clip's mean taken off, that hold the share `retain` of their variance. Frames without landmarks are
/// left out. Throws std::runtime_error if there is no frame with landmarks, the scheme lacks a name or the clips'
/// schemes differ, or the mouth does not move.
struct LearnMouthSpace {
  std::vector<std::string> reference = {"nose_bridge", "nose_base", "left_eye", "right_eye"};
  std::vector<std::string> mouth = {"outer_lips", "inner_lips"};
  double retain = 0.99;

  MouthSpace operator()(const Collected<LandmarkTrack>& landmarks) const;
};
void describe(Description<LearnMouthSpace>& d);

/// Mouth components of a clip's landmarks, its mean over measured frames taken off, which makes them a normalised
/// visual track. Frames without landmarks are lost and 0. Throws std::runtime_error where the scheme lacks a name, has
/// other points than the space, or no frame has landmarks.
struct MeasureMouth {
  Track operator()(const MouthSpace& space, const LandmarkTrack& landmarks) const;
};
void describe(Description<MeasureMouth>& d);

}  // namespace talkgraph
