#include "nodes/speech/average.h"

#include <stdexcept>

namespace talkgraph {

Track Average::operator()(const Track& track) const {
  if (track.dimension() == 0) throw std::runtime_error("a track without dimensions has no mean over them");
  return {track.values.rowwise().mean(), track.rate, track.start, {name}, track.lost};
}

void describe(Description<Average>& d) {
  d.type("speech.average").summary("the mean over a track's dimensions").source("Thesis §3.5.2, Eqn 6.10");
  d.input("track", "of any number of dimensions").output("track", "T x 1");
  d.param("name", &Average::name).doc("of the one dimension");
}

}  // namespace talkgraph
