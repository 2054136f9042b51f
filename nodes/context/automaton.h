#pragma once

#include <string>
#include <vector>

#include "nodes/types/vlmm.h"

namespace talkgraph {

/// Fills in the transitions: from memory w on σ to the longest suffix of wσ
/// that is a state, where σ was ever seen after w.
void connect_states(Vlmm& vlmm);

/// The context label of each frame: reading σ in memory w gives wσ. Where σ was
/// never seen after w, or at all, the label is σ alone and the memory restarts.
std::vector<std::string> context_labels(const Vlmm& vlmm, const std::vector<std::string>& phones);

/// The longest suffix of a label that is trainable; its last phone if none is.
std::string trainable_suffix(const Vlmm& vlmm, const std::string& label);

}  // namespace talkgraph
