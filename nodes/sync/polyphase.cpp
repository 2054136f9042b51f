#include "nodes/sync/polyphase.h"

#include <algorithm>
#include <cmath>

#include "nodes/sync/filter.h"

namespace talkgraph {

Track Polyphase::operator()(const Track& track, const Audio* audio) const {
  const double band = std::min(1.0, 1 / (track.rate / rate).value());  // kept share of the input's
  const double extent = zeros / band;                                  // of the filter on each side, input frames
  const auto reach = static_cast<Eigen::Index>(std::floor(extent)) + 1;
  return filter_to_video(track, audio, rate, reach, [&](double phase) -> Eigen::RowVectorXd {
    Eigen::RowVectorXd weights(2 * reach);
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const double at = static_cast<double>(i - reach + 1) - phase;
      weights[i] = sinc(at * band) * kaiser(at / extent, beta);
    }
    return weights / weights.sum();
  });
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
