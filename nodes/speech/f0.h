#pragma once

#include <vector>

#include "graph/description.h"
#include "nodes/types/frames.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class Unvoiced { zero, bridged };
template <>
inline constexpr EnumNames<Unvoiced, 2> enum_names<Unvoiced>{
    {{Unvoiced::zero, "zero"}, {Unvoiced::bridged, "bridged"}}};

/// A fundamental that a frame may have.
struct F0Candidate {
  double f0 = 0;        ///< Hz; 0: unvoiced
  double strength = 0;  ///< autocorrelation at the period, that of the window divided out: the share of periodic power
};

/// Fundamental frequency and voicing (T × 2) by the autocorrelation method of Boersma (1993), with the parameters,
/// defaults and meaning of Praat's "To Pitch (ac)". The peaks of each frame's autocorrelation are candidates; the path
/// through them of most strength and least jumps is taken over all frames. The voicing is the strength on that path, 0
/// in unvoiced frames. Their f0 is 0, or, `bridged`, interpolated in log f0 and held at the ends; without any voiced
/// frame it is 0.
///
/// Frames are unweighed and hold three periods of the floor (0.04 s for 75 Hz); std::invalid_argument if they do not.
struct F0 {
  double floor = 75;                ///< Hz
  double ceiling = 600;             ///< Hz
  int candidates = 15;              ///< of a frame, with the unvoiced one
  double silence_threshold = 0.03;  ///< frames below this share of the loudest peak are unvoiced
  double voicing_threshold = 0.45;  ///< strength of the unvoiced candidate
  double octave_cost = 0.01;        ///< per octave: of equals the highest fundamental is taken
  double octave_jump_cost = 0.35;   ///< per octave and 10 ms
  double voicing_cost = 0.14;       ///< of a change between voiced and unvoiced, per 10 ms
  Unvoiced unvoiced = Unvoiced::zero;

  Track operator()(const Frames& frames) const;
};
void describe(Description<F0>& d);

/// Autocorrelations of frames, each divided by r_0 and by the autocorrelation of the Hann window that it is taken with;
/// keeps plan and memory.
class NormalisedAutocorrelation {
 public:
  /// For frames of `length` samples, lags up to `longest` samples. Lags lie on a grid of at least 64000 a second.
  NormalisedAutocorrelation(Eigen::Index length, double sample_rate, Eigen::Index longest);

  /// Lag i / lags_per_second() for i = 0, 1 ...; all zero for silence.
  const Eigen::VectorXd& operator()(const Eigen::Ref<const Eigen::VectorXd>& frame);
  double lags_per_second() const { return lags_per_second_; }

 private:
  Eigen::VectorXd window_, window_lags_, padded_, bins_, lags_, out_;
  double lags_per_second_;
};

/// The unvoiced candidate and the strongest peaks of an autocorrelation.
void f0_candidates(const F0& how, const Eigen::VectorXd& autocorrelation, double lags_per_second,
                   std::vector<F0Candidate>& out);

}  // namespace talkgraph
