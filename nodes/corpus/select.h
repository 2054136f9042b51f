#pragma once

#include <optional>
#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// Lets recordings of some splits pass.
struct Select {
  std::vector<std::string> splits;  ///< empty: all

  std::optional<Recording> operator()(const Recording& recording) const;
};
void describe(Description<Select>& d);

}  // namespace talkgraph
