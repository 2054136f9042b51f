#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/run.h"

namespace talkgraph::cli {

struct StudyMakeCommand {
  std::string design;                       ///< STUDY.json
  std::vector<std::filesystem::path> runs;  ///< folders
  std::filesystem::path folder;             ///< of the study
};

/// `talkgraph study make`: draws the clips of a study from finished runs.
int run_study_make(const StudyMakeCommand& command, const RunCommand& run, const Registry& registry);

}  // namespace talkgraph::cli
