#include "nodes/sync/filter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "nodes/sync/video_frames.h"

namespace talkgraph {
namespace {

/// The first and last row repeated `n` times more.
Eigen::MatrixXd repeat_ends(const Eigen::MatrixXd& values, Eigen::Index n) {
  Eigen::MatrixXd padded(values.rows() + 2 * n, values.cols());
  padded << values.row(0).replicate(n, 1), values, values.row(values.rows() - 1).replicate(n, 1);
  return padded;
}

}  // namespace

double sinc(double x) {
  const double y = std::numbers::pi * x;
  return std::abs(y) < 1e-12 ? 1 : std::sin(y) / y;
}

double kaiser(double x, double beta) {
  return std::abs(x) > 1 ? 0 : std::cyl_bessel_i(0.0, beta * std::sqrt(1 - x * x));
}

Track filter_to_video(const Track& track, const Audio* audio, const Rational& rate, Eigen::Index reach,
                      const std::function<Eigen::RowVectorXd(double phase)>& weights) {
  Track out = unfilled(track, audio, rate);
  const Rational step = track.rate / rate;  // input frames in an output frame
  const double offset = step.value() / 2 - track.start * track.rate.value();
  const double last = static_cast<double>(out.frames() - 1) * step.value() + offset;
  const double beyond = std::max({0.0, -offset, last - static_cast<double>(track.frames() - 1)});
  const auto margin = reach + static_cast<Eigen::Index>(std::ceil(beyond));
  const Eigen::MatrixXd padded = repeat_ends(track.values, margin);
  std::map<std::int64_t, Eigen::RowVectorXd> bank;  // by phase: output frames step.den() apart share one
  for (Eigen::Index n = 0; n < out.frames(); ++n) {
    const auto turn = n / step.den(), part = n % step.den();
    const double within = static_cast<double>(part) * step.value() + offset, before = std::floor(within);
    auto& filter = bank[part];
    if (filter.size() == 0) filter = weights(within - before);
    const auto centre = turn * step.num() + static_cast<Eigen::Index>(before);
    out.values.row(n) = filter * padded.middleRows(margin + centre - reach + 1, 2 * reach);
  }
  return out;
}

}  // namespace talkgraph
