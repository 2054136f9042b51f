#include "nodes/evaluate/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace talkgraph {

Curves TakeCurves::operator()(const Collected<Track>& tracks) const {
  Curves out;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track curve = tracks[i];
    if (curve.dimension() <= std::max(dimension, 0))
      throw std::runtime_error(fmt::format("{}: no dimension {} in a track of {} dimensions", tracks.key(i),
                                           std::max(dimension, 0), curve.dimension()));
    if (dimension < 0)
      curve.values = curve.values.rowwise().mean().eval();
    else
      curve.values = curve.values.col(dimension).eval();
    curve.names.clear();
    out.keys.push_back(tracks.key(i));
    out.curves.push_back(std::move(curve));
  }
  return out;
}

void describe(Description<TakeCurves>& d) {
  d.type("evaluate.curves").summary("a curve over time of each sequence, to be drawn beside others");
  d.source("Thesis §6.2.3, Eqns 6.10 and 6.11");
  d.input("tracks", "of a method, or recorded").output("curves", "one a sequence");
  d.param("dimension", &TakeCurves::dimension).within(-1, 10000).doc("of the tracks, from 0; -1: the average over all");
}

}  // namespace talkgraph
