#pragma once

#include "graph/description.h"
#include "nodes/types/context_gp.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// What soft contexts hold alike, as tables; costs are of −ln kernel.
///   phones  a row a pair of phones, the most alike first: what it costs where one stands for the other all through the
///           window
///   sound   a row a dimension of the sound, numbered from 1: what it costs where it is one deviation off all through
///           the window
///   place   what it costs to be at the start of the recording, or at the end of speech, where the other is far from
///           it; no row if places are not compared
///   window  a row a neighbour, frames before it negative: its weight
struct InspectContextGp {
  struct Tables {
    Table phones, sound, place, window;
  };
  Tables operator()(const ContextGp& model) const;
};
void describe(Description<InspectContextGp>& d);

}  // namespace talkgraph
