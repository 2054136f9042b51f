#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "graph/registry.h"
#include "runtime/executor.h"
#include "study/design.h"

namespace talkgraph::study {

/// How graphs are run: files go below `folder`. Throws where a run does.
using RunGraph = std::function<RunResult(const Graph& graph, const std::filesystem::path& folder)>;

/// A study, and what whoever makes it should know of it.
struct MadeStudy {
  Study study;
  std::vector<std::string> notes;
};

/// Makes a study of the folders of runs: chooses clips, draws them as the runs' own graphs with the design's graph laid
/// over them, and writes FOLDER/clips and, last of all, FOLDER/study.json. The folder must be new, empty, or left by a
/// making that did not come to its end.
/// Complaints about the design go to `diagnostics`, and nothing is made then. Throws std::runtime_error that names a
/// run that is none, has not finished, has failures or nothing held out; std::invalid_argument that names the folder if
/// it holds other things.
std::optional<MadeStudy> make_study(const Design& design, const std::vector<std::filesystem::path>& runs,
                                    const std::filesystem::path& folder, const Registry& registry, const RunGraph& run,
                                    Diagnostics& diagnostics);

}  // namespace talkgraph::study
