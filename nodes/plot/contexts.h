#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// A Markov model of contexts as a picture: its suffix tree, a line a memory below its suffix, with the training
/// frames read in it and what is likeliest to follow; and, of at most 16 memories,
/// the automaton beside it (thesis Figures 5.3, 5.4), memories on a circle and an arrow with the
/// symbols and their probabilities from one to another. Of more than `most` memories those are drawn whose contexts
/// hold most frames.
struct PlotContexts {
  int most = 60;        ///< memories drawn
  double least = 0.05;  ///< probability of a transition that gets an arrow
  std::string title = "Phonetic contexts";

  Plot operator()(const Vlmm& vlmm) const;
};
void describe(Description<PlotContexts>& d);

}  // namespace talkgraph
