#pragma once

#include "graph/description.h"
#include "nodes/types/face_track.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// How a face was followed through one clip:
///   frames, lost        how many
///   confidence          mean over the frames that were not lost; least_confidence, the least of them
///   rms, worst          distance from the given landmarks, pixels: root mean square over frames and points, and of the
///                       frame where it is largest
/// Lost frames, and those where a given landmark is not a number, do not count in rms and worst, which are left out
/// without landmarks or without such a frame. Throws std::runtime_error if the numbers of points differ or lengths
/// differ by more than two frames.
struct ScoreTracking {
  Scores operator()(const FaceTrack& track, const LandmarkTrack* given) const;
};
void describe(Description<ScoreTracking>& d);

}  // namespace talkgraph
