#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class RastaStart { zero, steady };
template <>
inline constexpr EnumNames<RastaStart, 2> enum_names<RastaStart>{
    {{RastaStart::zero, "zero"}, {RastaStart::steady, "steady"}}};

enum class RastaKeep { pole, time_constant };
template <>
inline constexpr EnumNames<RastaKeep, 2> enum_names<RastaKeep>{
    {{RastaKeep::pole, "pole"}, {RastaKeep::time_constant, "time_constant"}}};

/// RASTA filter along time, for each band of log filter outputs (T × D):
///   y[t] = (2 x[t] + x[t-1] - x[t-3] - 2 x[t-4]) / 10 + pole y[t-1].
/// What stays the same in a band, as a microphone does, fades. The z⁴ in front of the 1994 paper's filter, which would
/// look four frames ahead, is left out, as in its implementations.
///
/// Hermansky and Morgan, RASTA processing of speech, 1994 (pole 0.98); rastamat (0.94, `start` zero).
struct Rasta {
  double pole = 0.94;  ///< at 100 frames per second
  RastaKeep keep = RastaKeep::pole;
  RastaStart start = RastaStart::zero;

  /// What the filter remembers between frames.
  struct State {
    Eigen::Matrix<double, Eigen::Dynamic, 4> before;  ///< x[t-1] ... x[t-4]
    Eigen::VectorXd last;                             ///< y[t-1]
    Eigen::Index frames = 0;                          ///< so far
  };
  /// Filters one frame in place; `pole` as pole_at gives it.
  void step(State& state, double pole, Eigen::Ref<Eigen::VectorXd> bands) const;
  /// The pole at a frame rate.
  double pole_at(Rational rate) const;

  Track operator()(const Track& track) const;
};
void describe(Description<Rasta>& d);

}  // namespace talkgraph
