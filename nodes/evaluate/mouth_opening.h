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
/// A score is left out where its phones do not occur; nothing is given for a
/// clip with none of them. Throws std::runtime_error if lengths differ by more
/// than two frames, the point scheme lacks a point, or the mouth has no width.
struct MouthOpening {
  std::vector<std::string> closed = {"p", "b", "m"};
  std::vector<std::string> open = {"aa", "ae", "ah", "ao", "aw", "ay"};
  int upper = 62;  ///< point in the middle of the inner upper lip (iBUG: 62)
  int lower = 66;  ///< point in the middle of the inner lower lip (iBUG: 66)
  int left = 48;   ///< corner of the mouth (iBUG: 48)
  int right = 54;  ///< the other corner (iBUG: 54)

  std::optional<Scores> operator()(const LandmarkTrack& landmarks, const FrameLabels& labels) const;
};
void describe(Description<MouthOpening>& d);

}  // namespace talkgraph
