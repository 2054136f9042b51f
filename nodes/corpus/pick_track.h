#pragma once

#include <optional>
#include <string>
#include <vector>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Lets the tracks of these recordings pass.
struct PickTrack {
  std::vector<std::string> ids;

  std::optional<Track> operator()(const Track& track, Context& context) const;
};
void describe(Description<PickTrack>& d);

}  // namespace talkgraph
