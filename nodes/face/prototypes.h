#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/types/phones.h"
#include "nodes/types/prototypes.h"
#include "nodes/types/shape.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Chooses `per_phone` frames of every phone at random and cuts the face out
/// of them. Clips are matched by key; a clip that lacks pictures, landmarks or
/// labels is passed over, as are damaged frames and frames with a landmark
/// missing (NaN) or outside the picture. Only clips with a chosen frame are
/// decoded. Throws std::runtime_error if no frame can be used. docs/method.md §2.
struct ChoosePrototypes {
  int per_phone = 4;

  Prototypes operator()(const Collected<Video>& videos, const Collected<LandmarkTrack>& landmarks,
                        const Collected<FrameLabels>& labels, Random& random, Context& context) const;
};
void describe(Description<ChoosePrototypes>& d);

}  // namespace talkgraph
