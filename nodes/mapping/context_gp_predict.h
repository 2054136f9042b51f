#pragma once

#include "graph/description.h"
#include "nodes/types/context_gp.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Mean and variance of the visual parameters at every frame, that of the noise included. Phones that training has not
/// met resemble none. Throws std::runtime_error on audio of another dimension or with values that are not finite.
struct PredictContextGp {
  struct Prediction {
    Track visual;
    Track variance;
  };
  Prediction operator()(const ContextGp& model, const Track& audio, const PhoneTrack& phones) const;
};
void describe(Description<PredictContextGp>& d);

}  // namespace talkgraph
