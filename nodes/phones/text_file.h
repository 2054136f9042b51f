#pragma once

#include <string>

#include "graph/context.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a text file FOLDER/ITEM + ending below the run folder, whole or not at all;
/// `otherwise` names it for a node that runs once. Throws std::runtime_error
/// that names the file.
Artifact write_text(const Context& context, const std::string& folder, const std::string& ending,
                    const std::string& otherwise, const std::string& text);

}  // namespace talkgraph
