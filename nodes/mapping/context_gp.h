#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
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
/// With these costs, window and noise begins the kernel that is learnt in `kernel_steps`, of
/// `kernel_utterances` each: −ln k = Σ_l w_l |(x_l − x'_l) map|² with x both streams, by leaving out utterances
/// (learn_kernel). Where fewer than two have speech, or with 0 steps, it stays as it begins.
///
/// Frames farther than `margin` from speech are pauses, of which every `pauses`-th is learnt; lost frames are not, and
/// of more than `max_frames` as many at even distances. The time grows with the cube, the memory with the square of
/// their number: 10 000 take 800 MB.
///
/// The variance is that of the deterministic training conditional (Quiñonero-Candela and Rasmussen 2005) with
/// `inducing` frames at even distances; that of the signal, for each visual parameter, the likeliest.
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
  int kernel_steps = 40;
  int kernel_utterances = 30;
  int margin = 4;
  int pauses = 3;
  int max_frames = 12000;
  int inducing = 1000;

  ContextGp operator()(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                       const Collected<Track>& visual, Random& random, Context& context) const;
};
void describe(Description<TrainContextGp>& d);

/// Mean and variance of the visual parameters at every frame, that of the noise included. Phones that training has not
/// met resemble none. Throws std::runtime_error on audio of another dimension or with values that are not finite.
struct PredictContextGp {
  struct Prediction {
    Track visual;
    Track variance;
  };
  Prediction operator()(const ContextGp& model, const Track& audio, const PhoneTrack& phones) const;
};
void describe(Description<PredictContextGp>& d);

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

/// How much of each frame each of these phones takes (T × phones): 0 to 1.
Eigen::MatrixXd phone_shares(const PhoneTrack& phones, const std::vector<std::string>& inventory, const Track& like);

}  // namespace talkgraph
