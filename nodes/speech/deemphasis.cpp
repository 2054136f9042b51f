#include "nodes/speech/deemphasis.h"

namespace talkgraph {

Audio Deemphasis::operator()(const Audio& audio) const {
  Audio out = audio;
  for (Eigen::Index t = 1; t < out.samples.size(); ++t) out.samples[t] += k * out.samples[t - 1];
  return out;
}

void describe(Description<Deemphasis>& d) {
  d.type("speech.deemphasis").summary("undoes pre-emphasis: x[t] = x'[t] + k x[t-1]").source("Thesis §3.2");
  d.input("audio", "at any rate").output("audio", "of the same rate and length");
  d.param("k", &Deemphasis::k).within(0, 1).doc("strength; 0 does nothing");
}

}  // namespace talkgraph
