#pragma once

#include <optional>
#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// Lets the recordings of these names pass; a name that none has is passed over, as every recording is looked at by
/// itself.
struct Pick {
  std::vector<std::string> ids;

  std::optional<Recording> operator()(const Recording& recording) const;
};
void describe(Description<Pick>& d);

}  // namespace talkgraph
