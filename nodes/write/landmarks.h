#pragma once

#include "graph/description.h"
#include "nodes/types/prototypes.h"
#include "nodes/types/report.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// Landmarks of one picture in the format of the iBUG annotations, as other programs read it: the centre of the top
/// left pixel is (1, 1). Throws std::invalid_argument if a point is missing (NaN): the format cannot say so.
std::string pts_text(const Shape& shape);

/// Writes the landmarks of each clip as FOLDER/ITEM/000000.pts, one a frame, which a corpus manifest reads back;
/// a frame without landmarks gets none. Errors: a file cannot be written, some points of a frame are missing, a clip
/// without a frame that has landmarks.
struct WriteLandmarks {
  std::string folder = "landmarks";

  Artifact operator()(const LandmarkTrack& landmarks, Context& context) const;
};
void describe(Description<WriteLandmarks>& d);

/// Writes pictures of a face with their landmarks: FOLDER/000000.png, and 000000.pts beside it. Errors: a file cannot
/// be written, a point is missing.
struct WritePrototypes {
  std::string folder = "prototypes";

  Artifact operator()(const Prototypes& prototypes, Context& context) const;
};
void describe(Description<WritePrototypes>& d);

}  // namespace talkgraph
