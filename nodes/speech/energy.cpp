#include "nodes/speech/energy.h"

namespace talkgraph {

Track Energy::operator()(const Frames& frames) const {
  Track out;
  out.rate = frames.rate;
  out.start = frames.start;
  out.names = {"energy"};
  out.values = (scale * frames.values).rowwise().squaredNorm().cwiseMax(floor).array().log();
  return out;
}

void describe(Description<Energy>& d) {
  d.type("speech.energy").summary("log energy of each frame").source("HTK Book, energy measures");
  d.input("frames", "without window and pre-emphasis, as HTK has it").output("track", "T x 1");
  d.param("scale", &Energy::scale).positive().doc("full scale of the samples: 32768 as 16-bit tools have it");
  d.param("floor", &Energy::floor).positive().doc("least energy before the log");
}

}  // namespace talkgraph
