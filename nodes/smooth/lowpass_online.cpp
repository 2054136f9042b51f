#include "nodes/smooth/lowpass_online.h"

#include <stdexcept>

#include "nodes/smooth/butterworth.h"

namespace talkgraph {

LowpassOnline::Out LowpassOnline::operator()(const Track& track, const Scores* latency) const {
  if (!track.values.allFinite()) throw std::runtime_error("a track with NaN or infinite values cannot be smoothed");
  const double rate = track.rate.value();
  const auto frames = track.frames();
  Out out{track, latency ? *latency : Scores{{{"latency", 0}, {"latency_most", 0}}}};
  if (cutoff >= rate / 2) return out;
  for (auto& [name, ms] : out.latency.values) ms += 1000 * delay / rate;
  if (frames == 0) return out;
  const Biquad filter = butterworth(cutoff, rate);
  Eigen::VectorXd extended(frames + delay);
  for (Eigen::Index d = 0; d < track.dimension(); ++d) {
    extended.head(frames) = track.values.col(d);
    extended.tail(delay).setConstant(track.values(frames - 1, d));
    filter.run(extended);
    out.track.values.col(d) = extended.tail(frames);
  }
  return out;
}

void describe(Description<LowpassOnline>& d) {
  d.type("smooth.lowpass_online").summary("low-pass of a track as it comes, of a stated delay");
  d.source("Thesis §5.3; this project's own for a stream");
  d.input("track", "at any rate").input("latency", "ms, of what made the track");
  d.output("track", &LowpassOnline::Out::track, "of the same size, its lag taken back by the delay");
  d.output("latency", &LowpassOnline::Out::latency, "the same with the delay added");
  d.param("cutoff", &LowpassOnline::cutoff)
      .positive()
      .unit("Hz")
      .doc("gain √½ here; at or above half the rate: off, without delay");
  d.param("delay", &LowpassOnline::delay).at_least(0).unit("frames").doc("frames that a frame waits for");
}

}  // namespace talkgraph
