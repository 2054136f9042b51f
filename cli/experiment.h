#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/run.h"

namespace talkgraph::cli {

struct ExperimentCommand {
  RunCommand run;            ///< of each trial; its folder is that of the experiment
  std::uint64_t memory = 0;  ///< bytes; 0: as free_memory() has it
  bool dry_run = false;      ///< list the trials and how much of each is kept
};

/// `talkgraph experiment`: runs all trials of an experiment file and writes tables, plots and the page that compares
/// them. The page is named on stdout, all else on stderr.
int run_experiment(const std::string& file, const ExperimentCommand& command, const Registry& registry);

}  // namespace talkgraph::cli
