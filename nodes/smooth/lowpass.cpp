#include "nodes/smooth/lowpass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace talkgraph {
namespace {

/// y[t] = b0 x[t] + b1 x[t-1] + b2 x[t-2] - a1 y[t-1] - a2 y[t-2]
struct Biquad {
  double b0, b1, b2, a1, a2;

  /// Filters in place, begun as if the first sample had stood for ever.
  void run(Eigen::Ref<Eigen::VectorXd> x) const {
    double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
    for (Eigen::Index t = 0; t < x.size(); ++t) {
      const double y = b0 * x[t] + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
      x2 = x1, x1 = x[t], y2 = y1, y1 = y;
      x[t] = y;
    }
  }
};

/// Bilinear transform of the Butterworth prototype.
Biquad butterworth(double cutoff, double rate) {
  const double k = std::tan(std::numbers::pi * cutoff / rate), norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
  return {k * k * norm, 2 * k * k * norm, k * k * norm, 2 * (k * k - 1) * norm,
          (1 - std::numbers::sqrt2 * k + k * k) * norm};
}

}  // namespace

Track Lowpass::operator()(const Track& track) const {
  if (!track.values.allFinite()) throw std::runtime_error("a track with NaN or infinite values cannot be smoothed");
  const double rate = track.rate.value();
  const auto frames = track.frames();
  if (cutoff >= rate / 2 || frames < 3) return track;
  const Biquad filter = butterworth(cutoff, rate);
  const auto pad = std::min<Eigen::Index>(frames - 1, static_cast<Eigen::Index>(std::ceil(3 * rate / cutoff)));
  Track out = track;
  Eigen::VectorXd padded(frames + 2 * pad);
  for (Eigen::Index d = 0; d < track.dimension(); ++d) {
    const auto x = track.values.col(d);
    for (Eigen::Index i = 0; i < pad; ++i) {
      padded[pad - 1 - i] = 2 * x[0] - x[i + 1];
      padded[pad + frames + i] = 2 * x[frames - 1] - x[frames - 2 - i];
    }
    padded.segment(pad, frames) = x;
    filter.run(padded);
    padded.reverseInPlace();
    filter.run(padded);
    padded.reverseInPlace();
    out.values.col(d) = padded.segment(pad, frames);
  }
  return out;
}

void describe(Description<Lowpass>& d) {
  d.type("smooth.lowpass").summary("zero-phase Butterworth low-pass").source("Thesis §5.3");
  d.input("track", "at any rate").output("track", "of the same size");
  d.param("cutoff", &Lowpass::cutoff).positive().unit("Hz").doc("gain ½ here; at or above half the rate: off");
}

}  // namespace talkgraph
