#include "nodes/speech/lattice.h"

#include <cmath>
#include <stdexcept>

#include "nodes/speech/line_spectrum.h"

namespace talkgraph {

using Eigen::Index;

void Lattice::set(const Eigen::VectorXd& k) {
  k_ = k;
  c_ = ((1 - k.array()) * (1 + k.array())).sqrt();
  scale_ = c_.prod();
}

double Lattice::analyse(double x) {
  double forward = x, backward = x;
  for (Index m = 0; m < k_.size(); ++m) {
    const double before = backward_[m];
    backward_[m] = backward;
    forward = (forward - k_[m] * before) / c_[m];
    backward = c_[m] * before - k_[m] * forward;
  }
  return scale_ * forward;
}

double Lattice::synthesise(double e) {
  double forward = e / scale_;
  for (Index m = k_.size() - 1; m >= 0; --m) {
    const double before = backward_[m];
    if (m + 1 < k_.size()) backward_[m + 1] = c_[m] * before - k_[m] * forward;
    forward = c_[m] * forward + k_[m] * before;
  }
  return backward_[0] = forward;
}

Eigen::RowVectorXd value_at(const Track& track, double seconds) {
  const double last = static_cast<double>(track.frames() - 1);
  const double at = std::clamp((seconds - track.start) * track.rate.value(), 0.0, last);
  const auto t = static_cast<Index>(at), next = std::min(t + 1, track.frames() - 1);
  const double share = at - static_cast<double>(t);
  return (1 - share) * track.values.row(t) + share * track.values.row(next);
}

LatticeTrack::LatticeTrack(const Track& lsf, double sample_rate, double step, double spacing)
    : lsf_(lsf),
      sample_rate_(sample_rate),
      spacing_(spacing),
      step_(std::max<Index>(1, static_cast<Index>(std::lround(step * sample_rate)))) {
  if (lsf.frames() == 0 || lsf.dimension() == 0) throw std::runtime_error("line spectral frequencies without frames");
  if (!lsf.values.allFinite()) throw std::runtime_error("line spectral frequencies that are NaN or infinite");
  check_spacing(spacing, lsf.dimension());
}

Index LatticeTrack::samples() const {
  const double seconds = 2 * lsf_.start + static_cast<double>(lsf_.frames() - 1) / lsf_.rate.value();
  return static_cast<Index>(std::lround(std::max(0.0, seconds) * sample_rate_));
}

Eigen::VectorXd LatticeTrack::reflection(double seconds) const {
  Eigen::VectorXd lsf = value_at(lsf_, seconds).transpose(), a(lsf.size()), k(lsf.size());
  keep_apart(spacing_, lsf);
  predictor_of(lsf, a);
  if (!step_down(a, k)) step_down(minimum_phase(a), k);
  return k;
}

}  // namespace talkgraph
