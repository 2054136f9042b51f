#include "nodes/sync/shift.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talkgraph {

Track shifted(const Track& track, double frames) {
  Track out = track;
  out.lost.clear();
  const double last = static_cast<double>(track.frames() - 1);
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const double at = std::clamp(static_cast<double>(t) + frames, 0.0, last);
    const auto a = static_cast<Eigen::Index>(std::floor(at)), b = static_cast<Eigen::Index>(std::ceil(at));
    const double share = at - static_cast<double>(a);
    out.values.row(t) = (1 - share) * track.values.row(a) + share * track.values.row(b);
    if (track.is_lost(a) || track.is_lost(b)) out.lost.push_back(t);
  }
  return out;
}

Track Shift::operator()(const Track& track, const Table& offsets, Context& context) const {
  const auto row = std::find(offsets.rows.begin(), offsets.rows.end(), context.item);
  const auto column = std::find(offsets.columns.begin(), offsets.columns.end(), late_column);
  if (row == offsets.rows.end() || column == offsets.columns.end())
    throw std::runtime_error("the table of offsets says nothing of this utterance: is it of the same recordings?");
  const auto at = static_cast<std::size_t>(row - offsets.rows.begin());
  return shifted(track,
                 offsets.cells[at][static_cast<std::size_t>(column - offsets.columns.begin())] * track.rate.value());
}

void describe(Description<Shift>& d) {
  d.type("sync.shift").summary("moves each utterance's track in time by its offset");
  d.input("track", "of an utterance")
      .input("offsets", "of all, by mapping.offsets")
      .output("track", "the same, in time with its sound");
}

}  // namespace talkgraph
