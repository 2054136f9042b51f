#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"
#include "nodes/types/mouths.h"

namespace talkgraph {

/// Keeps real mouths of the training clips, for synthesised faces to show: evenly spread over all frames but lost ones
/// and the worst fitted share. With no frame to take, there are no mouths.
/// Throws std::runtime_error if the model lacks a point, or the scheme the lips, or a track was made with another
/// model.
struct KeepMouths {
  std::vector<int> points;  ///< around the mouth; empty: outer and inner lips of the point scheme
  double margin = 0.2;      ///< of skin around them, share of the mouth's width
  int limit = 600;          ///< mouths kept at most
  double leave_out = 0.1;   ///< share of the frames, those of the largest residuals for their contrast

  Mouths operator()(const AppearanceModel& model, const Collected<Video>& videos, const Collected<FaceTrack>& tracks,
                    Context& context) const;
};
void describe(Description<KeepMouths>& d);

}  // namespace talkgraph
