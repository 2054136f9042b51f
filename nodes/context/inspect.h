#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// What a Markov model of contexts holds, as tables; frames are those of the training streams.
///   summary      one row: memories, transitions, labels, trainable ones; labels that at most `thin` frames carry, and
///                the share of all frames these are; median of the frames a label
///   memories     a row a memory: its number, its length, frames read in it, how many symbols may follow, and the
///                entropy of that choice in bits
///   labels       a row a label, the most occupied first (thesis Figures 5.7, 5.8): its length, the frames that
///                carry it, their share, and its training windows, no value where a suffix is trained in its place
///   transitions  a row a transition, named by the label that it gives: numbers of the memories it leads from and to,
///                its probability, frames that took it
/// A memory without symbols is called "none". A frame for which there was no transition counts as read in none.
struct InspectContexts {
  int thin = 5;

  struct Out {
    Table summary, memories, labels, transitions;
  };
  Out operator()(const Vlmm& vlmm) const;
};
void describe(Description<InspectContexts>& d);

}  // namespace talkgraph
