#pragma once

#include <string>
#include <vector>

#include "graph/json.h"

namespace talkgraph {

/// Where two values differ: `params/filters: 20 -> 30`, `params/k: nothing -> 1`. The order of members does not count.
std::vector<std::string> differences(const Json& before, const Json& after);

}  // namespace talkgraph
