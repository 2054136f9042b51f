#include "nodes/smooth/lowpass.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/smooth/butterworth.h"

namespace talkgraph {
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
