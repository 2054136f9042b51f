#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Where in its recording each frame is, T × 2: exp(−t / time) for t seconds since its first frame, and for t seconds
/// until speech ends at `end`, 1 thereafter.
Eigen::MatrixXd places(const Track& like, double end, double time);

/// That as features, to be joined to those of speech. Speech ends with the last label that is no pause; where nobody
/// speaks, with the recording.
struct PlaceInRecording {
  double time = 1.2;
  double weight = 1;

  Track operator()(const FrameLabels& labels) const;
};
void describe(Description<PlaceInRecording>& d);

}  // namespace talkgraph
