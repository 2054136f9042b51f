#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// Do the lips meet where they must, and part where they must? The gap between
/// the inner lips, as a share of the mouth's average width:
///   closed  smallest gap within a phone of `closed`, averaged over those phones
///   open    largest gap within a phone of `open`, averaged over those phones
///   pause   average gap of the frames labelled "sil"
/// Frames without landmarks do not count. A score is left out where its phones do not occur; nothing is given for a
/// clip with none of them. Throws std::runtime_error if lengths differ by more
/// than two frames, the scheme of the points is unknown or lacks a point, or the mouth has no width.
struct MouthOpening {
  std::vector<std::string> closed = {"p", "b", "m"};
  std::vector<std::string> open = {"aa", "ae", "ah", "ao", "aw", "ay"};
  std::string upper = "inner_top";     ///< point in the middle of the inner upper lip, by its name in the scheme
  std::string lower = "inner_bottom";  ///< of the inner lower lip
  std::string left = "mouth_left";     ///< corner of the mouth
  std::string right = "mouth_right";   ///< the other corner

  std::optional<Scores> operator()(const LandmarkTrack& landmarks, const FrameLabels& labels) const;
};
void describe(Description<MouthOpening>& d);

}  // namespace talkgraph
