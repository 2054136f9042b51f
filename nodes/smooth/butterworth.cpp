#include "nodes/smooth/butterworth.h"

#include <cmath>
#include <numbers>

namespace talkgraph {

void Biquad::run(Eigen::Ref<Eigen::VectorXd> x) const {
  double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
  for (Eigen::Index t = 0; t < x.size(); ++t) {
    const double y = b0 * x[t] + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
    x2 = x1, x1 = x[t], y2 = y1, y1 = y;
    x[t] = y;
  }
}

Biquad butterworth(double cutoff, double rate) {
  const double k = std::tan(std::numbers::pi * cutoff / rate), norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
  return {k * k * norm, 2 * k * k * norm, k * k * norm, 2 * (k * k - 1) * norm,
          (1 - std::numbers::sqrt2 * k + k * k) * norm};
}

}  // namespace talkgraph
