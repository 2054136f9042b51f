#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/types/phones.h"
#include "nodes/types/prototypes.h"
#include "nodes/types/shape.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// How prototypes are chosen.
enum class PrototypeChoice { random, coverage };
template <>
inline constexpr EnumNames<PrototypeChoice, 2> enum_names<PrototypeChoice>{
    {{PrototypeChoice::random, "random"}, {PrototypeChoice::coverage, "coverage"}}};

/// Chooses frames to build a face model from and cuts the face out of them:
/// `per_phone` of every phone at random, or as many in all so that they cover
/// the space of shapes: the frame nearest to the mean shape, then again and
/// again the one whose shape is farthest from all chosen (greedy k-centre;
/// distances between landmarks free of pose). Clips are matched by key; a clip that lacks pictures, landmarks or
/// labels is passed over, as are damaged frames and frames with a landmark
/// missing (NaN) or outside the picture. Only clips with a chosen frame are
/// decoded. Throws std::runtime_error if no frame can be used. docs/method.md §2.
struct ChoosePrototypes {
  int per_phone = 4;
  PrototypeChoice choose = PrototypeChoice::random;

  Prototypes operator()(const Collected<Video>& videos, const Collected<LandmarkTrack>& landmarks,
                        const Collected<FrameLabels>& labels, Random& random, Context& context) const;
};
void describe(Description<ChoosePrototypes>& d);

}  // namespace talkgraph
