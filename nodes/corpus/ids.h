#pragma once

#include <set>
#include <string>

namespace talkgraph {

/// Ids name files: at most 100 bytes, without '/' and control characters, not beginning with a dot.
bool is_id(const std::string& text);

/// An id made of a name, which has '-' for what an id must not hold, is cut where it is too long, and ends in "-2",
/// "-3" where it is taken already. It is taken then.
std::string unique_id(const std::string& name, std::set<std::string>& taken);

}  // namespace talkgraph
