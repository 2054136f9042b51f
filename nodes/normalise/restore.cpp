#include "nodes/normalise/restore.h"

#include <stdexcept>

namespace talkgraph {

Track Restore::operator()(const Track& centred, const Track& mean) const {
  if (mean.frames() != 1 || mean.dimension() != centred.dimension())
    throw std::runtime_error("a mean of " + std::to_string(mean.frames()) + " x " + std::to_string(mean.dimension()) +
                             " does not fit a track of " + std::to_string(centred.dimension()) + " dimensions");
  Track out = centred;
  out.values.rowwise() += mean.values.row(0);
  return out;
}

void describe(Description<Restore>& d) {
  d.type("normalise.restore").summary("puts a mean back on a centred track").source("Thesis §3.4, Eqn 3.36");
  d.input("centred", "track without its mean").input("mean", "1 x D").output("track", "the two added");
}

}  // namespace talkgraph
