#pragma once

#include "graph/description.h"
#include "nodes/types/segments.h"
#include "nodes/types/track.h"
#include "nodes/types/yardsticks.h"

namespace talkgraph {

/// The mean visual trajectory of every state: the mean of its training windows, each stretched, by linear
/// interpolation, to their mean length. Throws std::runtime_error, naming the state, on no states, values that are not
/// finite, and where dimensions differ.
struct TrajectoriesTrain {
  TrajectoriesModel operator()(const Collected<StateData>& states) const;
};
void describe(Description<TrajectoriesTrain>& d);

/// For every segment the mean trajectory of its state, stretched to the segment's length; of a state that training had
/// none of, that of the longest suffix of its label, else the state with most frames that ends in the same phone, else
/// the mean of all windows' frames. Throws std::runtime_error if segments leave gaps or overlap.
struct TrajectoriesPredict {
  Track operator()(const TrajectoriesModel& model, const SegmentTrack& segments) const;
};
void describe(Description<TrajectoriesPredict>& d);

}  // namespace talkgraph
