#pragma once

#include "nodes/mapping/context_gp.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// How late the pictures of each training utterance are against their sound, s: the shift by which they come nearest to
/// what soft contexts learnt from all the others say (`leave_one_out`), within `largest` frames, in steps of an eighth.
/// Near is the squared distance, each visual parameter in units of its variance, their means over the utterance taken
/// off. Utterances of which nothing is learnt are in time.
///
/// Errors of TrainContextGp; std::runtime_error if there is one utterance only.
struct EstimateOffsets {
  TrainContextGp process = {};
  double largest = 2;

  Table operator()(const Collected<Track>& audio, const Collected<PhoneTrack>& phones, const Collected<Track>& visual,
                   Context& context) const;
};
void describe(Description<EstimateOffsets>& d);

}  // namespace talkgraph
