#pragma once

#include "nodes/mapping/context_gp.h"

namespace talkgraph {

/// What all other utterances say of one, at those of its frames that are learnt.
struct HeldOut {
  std::string key;
  std::vector<Eigen::Index> frames;
  Eigen::MatrixXd predicted;  ///< a row a frame
};

/// Of every utterance, in closed form: ẑ_u = z_u − ((K + σ²I)⁻¹_uu)⁻¹ ((K + σ²I)⁻¹ (Z − mean))_u, which takes one
/// factorisation and as long again. The kernel is as the node gives it. Errors of TrainContextGp; std::runtime_error if
/// there is one utterance only.
std::vector<HeldOut> leave_one_out(const TrainContextGp& node, const Collected<Track>& audio,
                                   const Collected<PhoneTrack>& phones, const Collected<Track>& visual,
                                   Context& context);

}  // namespace talkgraph
