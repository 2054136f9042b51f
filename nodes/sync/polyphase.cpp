#include "nodes/sync/polyphase.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "nodes/sync/video_frames.h"

namespace talkgraph {
namespace {

double sinc(double x) {
  const double y = std::numbers::pi * x;
  return std::abs(y) < 1e-12 ? 1 : std::sin(y) / y;
}

/// Not normalised: the weights are, afterwards.
double kaiser(double x, double beta) {
  return std::abs(x) > 1 ? 0 : std::cyl_bessel_i(0.0, beta * std::sqrt(1 - x * x));
}

/// Low-pass filter cut at `band` of the input's Nyquist frequency, as weights of
/// 2 · reach input frames; its centre lies `phase` (0..1) behind the reach-th.
Eigen::RowVectorXd filter(double phase, Eigen::Index reach, double band, double extent, double beta) {
  Eigen::RowVectorXd weights(2 * reach);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const double at = static_cast<double>(i - reach + 1) - phase;
    weights[i] = sinc(at * band) * kaiser(at / extent, beta);
  }
  return weights / weights.sum();
}

/// The first and last row repeated `n` times more.
Eigen::MatrixXd repeat_ends(const Eigen::MatrixXd& values, Eigen::Index n) {
  Eigen::MatrixXd padded(values.rows() + 2 * n, values.cols());
  padded << values.row(0).replicate(n, 1), values, values.row(values.rows() - 1).replicate(n, 1);
  return padded;
}

}  // namespace

Track Polyphase::operator()(const Track& track, const Audio* audio) const {
  check_finite(track);
  Track out;
  out.rate = rate;
  out.start = video_time(0, rate);
  out.names = track.names;
  out.values.resize(video_frames(track, audio, rate), track.dimension());
  const Rational step = track.rate / rate;              // input frames in an output frame
  const double band = std::min(1.0, 1 / step.value());  // kept share of the input's
  const double extent = zeros / band;                   // of the filter on each side, input frames
  const auto reach = static_cast<Eigen::Index>(std::floor(extent)) + 1;
  const double offset = step.value() / 2 - track.start * track.rate.value();
  const double last = static_cast<double>(out.frames() - 1) * step.value() + offset;
  const double beyond = std::max({0.0, -offset, last - static_cast<double>(track.frames() - 1)});
  const auto margin = reach + static_cast<Eigen::Index>(std::ceil(beyond));
  const Eigen::MatrixXd padded = repeat_ends(track.values, margin);
  std::map<std::int64_t, Eigen::RowVectorXd> bank;  // by phase: output frames step.den() apart share one
  for (Eigen::Index n = 0; n < out.frames(); ++n) {
    const auto turn = n / step.den(), part = n % step.den();
    const double within = static_cast<double>(part) * step.value() + offset, before = std::floor(within);
    auto& weights = bank[part];
    if (weights.size() == 0) weights = filter(within - before, reach, band, extent, beta);
    const auto centre = turn * step.num() + static_cast<Eigen::Index>(before);
    out.values.row(n) = weights * padded.middleRows(margin + centre - reach + 1, 2 * reach);
  }
  return out;
}

void describe(Description<Polyphase>& d) {
  d.type("sync.polyphase")
      .summary("to the video rate by anti-aliased resampling at the exact ratio")
      .source("Thesis §3.5.1");
  d.input("track", "at any rate").input("audio", "gives the exact length").output("track", "at the video rate");
  d.param("rate", &Polyphase::rate).positive().unit("frames/s").doc("video rate");
  d.param("zeros", &Polyphase::zeros).within(1, 100).doc("zero crossings of the filter on each side");
  d.param("beta", &Polyphase::beta).within(0, 30).doc("of the Kaiser window: more suppresses aliases more");
}

}  // namespace talkgraph
