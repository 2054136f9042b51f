#include "nodes/speech/preemphasis.h"

namespace talkgraph {

Audio PreEmphasis::operator()(const Audio& audio) const {
  const auto n = audio.samples.size();
  if (n == 0) return audio;
  Audio out{Eigen::VectorXd(n), audio.rate};
  out.samples[0] = (1 - k) * audio.samples[0];
  out.samples.tail(n - 1) = audio.samples.tail(n - 1) - k * audio.samples.head(n - 1);
  return out;
}

void describe(Description<PreEmphasis>& d) {
  d.type("speech.preemphasis")
      .summary("lifts high frequencies: x'[t] = x[t] - k x[t-1]")
      .source("Thesis §3.2, Eqn 3.22");
  d.input("audio", "at any rate").output("audio", "of the same rate and length");
  d.param("k", &PreEmphasis::k).within(0, 1).doc("strength; 0 switches it off");
}

}  // namespace talkgraph
