#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Moves a track in time by what a table says of its utterance (`mapping.offsets`): one that is late by x seconds
/// shows at t what it showed at t + x. Throws std::runtime_error if the table has no row of the utterance, or no column
/// "late, s".
struct Shift {
  Track operator()(const Track& track, const Table& offsets, Context& context) const;
};
void describe(Description<Shift>& d);

/// Frame t holds what stood at t + `frames`, interpolated linearly; beyond an end stands that end's value. Lost are
/// frames to which a lost one contributes.
Track shifted(const Track& track, double frames);

/// The column of offsets.
inline constexpr const char* late_column = "late, s";

}  // namespace talkgraph
