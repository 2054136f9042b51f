#include "nodes/evaluate/lag.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace talkgraph {
namespace {

/// Over the places where the first has a value.
double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  std::vector<Eigen::Index> there;
  for (Eigen::Index t = 0; t < a.size(); ++t)
    if (!std::isnan(a(t))) there.push_back(t);
  if (there.size() < 3) return NAN;
  const Eigen::VectorXd x = a(there).array() - a(there).mean(), y = b(there).array() - b(there).mean();
  const double product = x.norm() * y.norm();
  return product > 1e-9 ? x.dot(y) / product : NAN;
}

}  // namespace

Eigen::VectorXd sound_envelope(const Audio& audio, const Rational& fps, Eigen::Index frames) {
  Eigen::VectorXd out(frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto at = [&](Eigen::Index n) {
      return std::min<Eigen::Index>(audio.samples.size(),
                                    std::lround(static_cast<double>(n) / fps.value() * audio.rate));
    };
    const auto from = at(t), n = at(t + 1) - from;
    const double power = n > 0 ? audio.samples.segment(from, n).squaredNorm() / static_cast<double>(n) : 0;
    out[t] = std::log10(power + 1e-6);
  }
  return out;
}

Eigen::VectorXd lag_correlations(const Eigen::VectorXd& movement, const Eigen::VectorXd& envelope, int max_lag) {
  const auto frames = std::min(movement.size(), envelope.size());
  Eigen::VectorXd out(2 * max_lag + 1);
  for (int lag = -max_lag; lag <= max_lag; ++lag) {
    const auto n = frames - std::abs(lag);
    out(lag + max_lag) =
        n < 3 ? NAN : correlation(movement.segment(std::max(lag, 0), n), envelope.segment(std::max(-lag, 0), n));
  }
  return out;
}

}  // namespace talkgraph
