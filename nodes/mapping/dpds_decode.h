#pragma once

#include "graph/description.h"
#include "nodes/types/dpds.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The phones of a face whose labels are unknown, by approximate Viterbi (Englebienne 2009): for each phone of each
/// frame only the likeliest path to it is kept, with the point that this path has led to. Lost frames count as not
/// observed; no frames give no labels. Throws std::runtime_error on another dimension than the model's, on values
/// that are not finite, and where points that grow without bound overflow.
struct DecodeDpds {
  FrameLabels operator()(const Dpds& model, const Track& visual) const;
};
void describe(Description<DecodeDpds>& d);

}  // namespace talkgraph
