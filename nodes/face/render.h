#pragma once

#include "graph/description.h"
#include "nodes/face/part.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/eyes.h"
#include "nodes/types/mouths.h"
#include "nodes/types/track.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// The face of appearance parameters alone, at the mean pose on a plain
/// background, with average light (Eqn 3.18); with other eyes or real mouths if they are given. One pixel of the mean
/// shape is `zoom` pixels, or as many as fit into pictures of a given size. Of the lower part all rows below the eyes
/// are seen. What is shown where depends on the model alone. Rendered when read. Throws std::runtime_error if
/// parameters, eyes or mouths do not fit the model or each other, or the lower part is asked for and nobody knows where
/// the eyes are.
struct RenderFace {
  double zoom = 2;
  int background = 128;  ///< grey level
  FacePart part = FacePart::whole;
  int size = 0;  ///< of square pictures, pixels; 0: as large as the face needs

  Video operator()(const AppearanceModel& model, const Track& parameters, const Eyes* eyes,
                   const MouthTrack* mouths) const;
};
void describe(Description<RenderFace>& d);

/// One picture of the face, as RenderFace draws it.
cv::Mat draw_face(const AppearanceModel& model, const Eigen::VectorXd& c, double zoom, int background);

}  // namespace talkgraph
