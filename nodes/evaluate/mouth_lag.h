#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/report.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// Is the mouth in time with the sound? Correlates the opening of the inner
/// lips with the log envelope of the sound at shifts of up to ±max_lag frames:
///   lag          shift of the highest correlation, frames; above 0: the mouth is late
///   correlation  at that shift
///   in_time      correlation without a shift
/// Frames without landmarks do not count; nothing is given where either does not vary.
struct MouthLag {
  int max_lag = 6;
  std::string upper = "inner_top";     ///< point in the middle of the inner upper lip, by its name in the scheme
  std::string lower = "inner_bottom";  ///< of the inner lower lip

  std::optional<Scores> operator()(const LandmarkTrack& landmarks, const Audio& audio) const;
};
void describe(Description<MouthLag>& d);

}  // namespace talkgraph
