#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/context_gp.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Learns an exact Gaussian process from sound and phones, `reach` frames on both sides, to visual parameters
/// (docs/method.md §5). Instead of a label that fits or does not, a context counts the more the more it resembles:
///   −ln k = Σ_l w_l (sound · ½ mean_d (a_d − a'_d)² + phones · ½ |o − o'|²),  w_l ∝ exp(−(l / width)²),
/// a z-scored audio features and o the share of the frame that each phone takes. So unrelated sound costs `sound`, a
/// different phone `phones`.
///
/// Frames farther than `margin` from speech are pauses, of which every `pauses`-th is learnt; lost frames are not, and
/// of more than `max_frames` as many at even distances. The time grows with the cube, the memory with the square of
/// their number: 10 000 take 800 MB.
///
/// Utterances are paired by key; one that lacks sound, phones or face is left out. Throws std::runtime_error if none is
/// left or nothing was measured, on values that are not finite, and where dimensions differ or lengths do by more than
/// two frames.
struct TrainContextGp {
  int reach = 8;
  double width = 4;
  double sound = 0.6;
  double phones = 2;
  double noise = 1;
  int margin = 4;
  int pauses = 3;
  int max_frames = 12000;

  ContextGp operator()(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                       const Collected<Track>& visual, Context& context) const;
};
void describe(Description<TrainContextGp>& d);

/// The mean of the process at every frame. Phones that training has not met resemble none. Throws std::runtime_error on
/// audio of another dimension or with values that are not finite.
struct PredictContextGp {
  Track operator()(const ContextGp& model, const Track& audio, const PhoneTrack& phones) const;
};
void describe(Description<PredictContextGp>& d);

/// How much of each frame each of these phones takes (T × phones): 0 to 1.
Eigen::MatrixXd phone_shares(const PhoneTrack& phones, const std::vector<std::string>& inventory, const Track& like);

}  // namespace talkgraph
