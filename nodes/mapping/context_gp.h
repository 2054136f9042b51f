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
/// different phone `phones`. With `place` above 0, `place` |e − e'|² joins the sum, e being exp(−t / place_time) for
/// the time t since the recording begins and for that until speech ends: speakers settle, and come to rest.
///
/// With these costs, window and noise begins the kernel that is learnt in `kernel_steps`, of
/// `kernel_utterances` each: −ln k = Σ_l w_l |(x_l − x'_l) map|² with x all of these, by leaving out utterances
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
/// two frames; FactorisationError where the noise is too small.
struct TrainContextGp {
  int reach = 8;
  double width = 4;
  double sound = 0.6;
  double phones = 2;
  double place = 0;
  double place_time = 1.2;
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

}  // namespace talkgraph
