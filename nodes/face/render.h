#pragma once

#include "graph/description.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/eyes.h"
#include "nodes/types/mouths.h"
#include "nodes/types/track.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// The face of appearance parameters alone, at the mean pose on a plain
/// background, with average light (Eqn 3.18); with other eyes or real mouths if they are given. One pixel of the mean
/// shape is `zoom` pixels. Rendered when read. Throws std::runtime_error if parameters, eyes or mouths do not fit the
/// model or each other.
struct RenderFace {
  double zoom = 2;
  int background = 128;  ///< grey level

  Video operator()(const AppearanceModel& model, const Track& parameters, const Eyes* eyes,
                   const MouthTrack* mouths) const;
};
void describe(Description<RenderFace>& d);

/// One picture of the face, as RenderFace draws it.
cv::Mat draw_face(const AppearanceModel& model, const Eigen::VectorXd& c, double zoom, int background);

}  // namespace talkgraph
