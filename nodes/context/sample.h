#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// New phone streams drawn from a Markov model, keyed "sample001" ... Each begins with the empty memory and ends in a
/// memory as often as training streams did there, or after `most` symbols; where nothing can follow but what was
/// pruned, the memory restarts. Pauses at the ends of utterances are not drawn. Of a model of runs a symbol lasts as
/// long as its runs did in training on average. Throws std::runtime_error if the model has no transition to begin with.
struct ContextSample {
  std::int64_t sequences = 10;
  std::int64_t most = 500;  ///< symbols of a sequence
  Rational rate{25};        ///< of its frames

  Stream<FrameLabels> operator()(const Vlmm& vlmm, Random& random) const;
};
void describe(Description<ContextSample>& d);

}  // namespace talkgraph
