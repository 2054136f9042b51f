#pragma once

#include <filesystem>
#include <string>

#include "nodes/types/report.h"

namespace talkgraph {

/// Writes a text file below the run folder, whole or not at all. Throws
/// std::runtime_error that names the file.
Artifact write_text(const std::filesystem::path& run_folder, const std::string& path, const std::string& text,
                    std::string title);

}  // namespace talkgraph
