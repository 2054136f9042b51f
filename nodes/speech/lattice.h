#pragma once

#include <algorithm>

#include "nodes/types/track.h"

namespace talkgraph {

/// The filters A(z) and 1 / A(z) as a normalised lattice, sample by sample. Each stage is a rotation, so 1 / A(z) stays
/// bounded however the reflection coefficients change; and the two undo each other while they do.
class Lattice {
 public:
  explicit Lattice(Eigen::Index order) : k_(order), c_(order), backward_(Eigen::VectorXd::Zero(order)) {}

  /// Reflection coefficients from now on, all |k| < 1; the state is kept.
  void set(const Eigen::VectorXd& k);
  /// The residual of a sample.
  double analyse(double x);
  /// The sample of a residual.
  double synthesise(double e);

 private:
  Eigen::VectorXd k_, c_, backward_;
  double scale_ = 1;
};

/// A track between its frames: linear from centre to centre, held before the first and after the last.
Eigen::RowVectorXd value_at(const Track& track, double seconds);

/// Filters along a track of line spectral frequencies, for sound of `sample_rate`. A filter serves for `step` seconds;
/// the frequencies are interpolated to their middle and kept `spacing` rad apart.
class LatticeTrack {
 public:
  /// Throws std::runtime_error if the track has no frames or values that are not finite, std::invalid_argument if so
  /// many frequencies do not fit.
  LatticeTrack(const Track& lsf, double sample_rate, double step, double spacing);

  /// Of the sound from 0 to as far behind the last frame's centre as the first one's is from 0.
  Eigen::Index samples() const;

  /// Calls use(lattice, from, to, seconds), the middle of the step, for every step of `samples` samples in order.
  template <class Use>
  void each(Eigen::Index samples, Use use) const {
    Lattice lattice(lsf_.dimension());
    for (Eigen::Index from = 0; from < samples; from += step_) {
      const auto to = std::min(samples, from + step_);
      const double seconds = static_cast<double>(from + to) / 2 / sample_rate_;
      lattice.set(reflection(seconds));
      use(lattice, from, to, seconds);
    }
  }

 private:
  Eigen::VectorXd reflection(double seconds) const;

  const Track& lsf_;
  double sample_rate_, spacing_;
  Eigen::Index step_;
};

}  // namespace talkgraph
