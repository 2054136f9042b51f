#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// Learns a variable length Markov model from phone-per-frame streams (spec §5,
/// thesis §5.2.1, Algorithm 3). A memory w with |w| ≤ order is kept if it
/// predicts the next phone better than its suffix does,
///   ΔH(σw, w) = p(σw) Σ_σ' p(σ'|σw) ln(p(σ'|σw) / p(σ'|w)) ≥ keep;
/// strings seen in a share of at most `prune` of the frames are not looked at.
/// Every phone is an alphabet symbol. Throws std::runtime_error if there is no frame.
struct ContextTrain {
  int order = 6;        ///< N, longest memory, frames
  double prune = 1e-4;  ///< ε_p
  double keep = 1e-5;   ///< ε_s, nats
  int min_windows = 5;  ///< labels with fewer training windows are mapped to a suffix

  Vlmm operator()(const Collected<FrameLabels>& labels) const;
};
void describe(Description<ContextTrain>& d);

}  // namespace talkgraph
