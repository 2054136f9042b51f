#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/ssgpdm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The E-step of a switching model whose segmentation is not taken as given (docs/method.md §5, thesis §5.1.3): the
/// phones of an utterance stay in their order, each boundary between two of them moves by at most `reach` frames, to
/// where
///   Σ over runs  max_X ln p(Ŷ, Ẑ | X) + w ln p(X)
/// is greatest, p being the state of the run's phone, in the features' own units, and w the weight that its dynamics
/// have in synthesis: the objective of sequence optimisation, no likelihood where w is not 1. States are phones
/// (context.windows). The best boundaries are found by dynamic programming, X by optimisation from the nearest training
/// window. Without `visual`, for speech to be synthesised, Ẑ is left out. Training on the new labels is the M-step.
///
/// Streams that differ by at most 2 frames are used on their common beginning; labels beyond it stay. An utterance with
/// lost frames keeps its labels. Throws std::runtime_error if streams differ by more, on other dimensions than the
/// model's, on values that are not finite, and where no segmentation has a finite likelihood.
struct Resegment {
  struct Out {
    FrameLabels labels;
    /// "objective" a frame; "before", that of the labels given, if it is finite; "moved", the share of frames
    /// relabelled.
    Scores scores;
  };
  int reach = 2;
  int iterations = 3;

  Out operator()(const Ssgpdm& model, const FrameLabels& labels, const Track& audio, const Track* visual,
                 Context& context) const;
};
void describe(Description<Resegment>& d);

}  // namespace talkgraph
