#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// How well a Markov model predicts other phone streams (thesis Eqns 5.25 to
/// 5.27), as a table of one row:
///   perplexity  2^H
///   entropy     H = −1/N Σ log₂ max(P(σ_n | s_{n−1}), floor), bits a symbol, s_0 being the empty memory
///   best_path   the same along the likeliest path. What went before a stream is unknown, so it may begin in any
///               memory; from there on the automaton is deterministic, and each beginning is one path
///   missed      share of the symbols for which there was no transition
///   symbols     N: frames, or runs, as the model was trained on; pauses at an end do not count
///   memories, trainable  of the model: kept memories, labels that have a state of their own
/// Throws std::runtime_error if there is no symbol.
struct ContextPerplexity {
  double floor = 1e-4;  ///< least probability: what an unseen phone or transition counts

  Table operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels) const;
};
void describe(Description<ContextPerplexity>& d);

}  // namespace talkgraph
