#pragma once

#include "graph/description.h"
#include "nodes/types/ssgpdm.h"

namespace talkgraph {

/// Puts the SGPDMs of all states together into one switching model.
///
/// Throws std::runtime_error if there is none, if two have one label, or if
/// their audio or visual dimensions differ.
struct AssembleSsgpdm {
  Ssgpdm operator()(const Collected<Sgpdm>& states) const;
};
void describe(Description<AssembleSsgpdm>& d);

/// The state that speaks for a segment: its label's own; else that of the
/// longest suffix with a state; else the one with most training frames among
/// those that end in the same phone; else the one whose mean audio is nearest
/// to `audio_mean` (1 × D_Y) in its own scaling. There is always one.
const Sgpdm& state_for(const Ssgpdm& model, const std::string& label, const Eigen::RowVectorXd& audio_mean);

}  // namespace talkgraph
