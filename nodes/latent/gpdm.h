#pragma once

#include "nodes/latent/latent_training.h"
#include "nodes/types/gpdm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Trains a GPDM on tracks of one stream, or a GPLVM where there are no
/// dynamics, from PPCA. Every run of measured frames is a sequence: nothing is
/// learnt from lost frames, and no step leads over them.
///
/// Throws std::runtime_error if no track has a measured frame, on tracks of different dimensions and on values that are
/// not finite; std::invalid_argument if `fixed` names an unknown parameter.
struct TrainGpdm : LatentTraining {
  OutputScaling scaling = OutputScaling::per_dimension;

  TrainGpdm();
  Gpdm operator()(const Collected<Track>& tracks, Context& context) const;
};
void describe(Description<TrainGpdm>& d);

}  // namespace talkgraph
