#pragma once

#include "graph/context.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// The name of what a node writes for its item: FOLDER/STEM + ending below the
/// run folder, STEM being prefix + item + suffix, or `otherwise` for a node that
/// runs once and has neither. A slash in an item begins a folder. The title is
/// the stem.
Artifact item_file(const Context& context, const std::string& folder, const std::string& ending,
                   const std::string& otherwise, const std::string& prefix = "", const std::string& suffix = "");

}  // namespace talkgraph
