#include "nodes/normalise/restore.h"

#include <algorithm>
#include <stdexcept>

namespace talkgraph {

Track Restore::operator()(const Track& centred, const Track& mean) const {
  const auto rows = mean.frames();
  if (rows == 0 || (rows > 1 && rows + 2 < centred.frames()) || mean.dimension() != centred.dimension())
    throw std::runtime_error("an offset of " + std::to_string(rows) + " x " + std::to_string(mean.dimension()) +
                             " does not fit a track of " + std::to_string(centred.frames()) + " x " +
                             std::to_string(centred.dimension()));
  Track out = centred;
  for (Eigen::Index t = 0; t < out.frames(); ++t) out.values.row(t) += mean.values.row(std::min(t, rows - 1));
  return out;
}

void describe(Description<Restore>& d) {
  d.type("normalise.restore")
      .summary("puts back what normalising took off a track")
      .source("Thesis §3.4.1, Eqns 3.36-3.38");
  d.input("centred", "track without it").input("mean", "1 x D, or a row a frame").output("track", "the two added");
}

}  // namespace talkgraph
