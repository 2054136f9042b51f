#include "nodes/sync/polyphase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nodes/sync/video_frames.h"

namespace talkgraph {
namespace {

double sinc(double x) {
  const double y = std::numbers::pi * x;
  return std::abs(y) < 1e-12 ? 1 : std::sin(y) / y;
}

double kaiser(double x, double beta) {
  return std::abs(x) >= 1 ? 0 : std::cyl_bessel_i(0.0, beta * std::sqrt(1 - x * x)) / std::cyl_bessel_i(0.0, beta);
}

}  // namespace

Track Polyphase::operator()(const Track& track, const Audio* audio) const {
  check_finite(track);
  Track out;
  out.rate = rate;
  out.start = video_time(0, rate);
  out.names = track.names;
  out.values.setZero(video_frames(track, audio, rate), track.dimension());
  const double in_rate = track.rate.value();
  const double bandwidth = std::min(1.0, rate.value() / in_rate);  // kept share of the input's band
  const double reach = zeros / bandwidth;                          // input frames
  for (Eigen::Index n = 0; n < out.frames(); ++n) {
    const double centre = (video_time(n, rate) - track.start) * in_rate;
    double sum = 0;
    for (double i = std::ceil(centre - reach); i <= centre + reach; ++i) {
      const double weight = sinc((i - centre) * bandwidth) * kaiser((i - centre) / reach, beta);
      const auto row = static_cast<Eigen::Index>(std::clamp(i, 0.0, static_cast<double>(track.frames() - 1)));
      out.values.row(n) += weight * track.values.row(row);
      sum += weight;
    }
    out.values.row(n) /= sum;
  }
  return out;
}

void describe(Description<Polyphase>& d) {
  d.type("sync.polyphase")
      .summary("to the video rate by anti-aliased resampling at the exact ratio")
      .source("Thesis §3.5.1");
  d.input("track").input("audio", "gives the exact length").output("track");
  d.param("rate", &Polyphase::rate).positive().unit("frames/s").doc("video rate");
  d.param("zeros", &Polyphase::zeros).within(1, 100).doc("zero crossings of the filter on each side");
  d.param("beta", &Polyphase::beta).within(0, 30).doc("of the Kaiser window: more suppresses aliases more");
}

}  // namespace talkgraph
