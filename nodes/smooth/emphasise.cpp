#include "nodes/smooth/emphasise.h"

#include "nodes/smooth/lowpass.h"

namespace talkgraph {

Track Emphasise::operator()(const Track& track) const {
  Track out = Lowpass{cutoff}(track);
  out.values += gain * (track.values - out.values);
  return out;
}

void describe(Description<Emphasise>& d) {
  d.type("smooth.emphasise").summary("makes fast movement larger, for methods that move too little");
  d.input("track", "any track").output("track", "the same, moving more");
  d.param("cutoff", &Emphasise::cutoff).positive().unit("Hz").doc("slower changes stay as they are");
  d.param("gain", &Emphasise::gain).at_least(0).doc("of faster ones; 1: nothing is done");
}

}  // namespace talkgraph
