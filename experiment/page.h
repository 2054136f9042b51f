#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/meanings.h"
#include "experiment/results.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Means with their intervals, a picture an output: as lines over the first factor that is a number, else as bars.
std::vector<Plot> plot_estimates(const Experiment& experiment, const std::vector<Estimate>& estimates);

/// Complaints about measures that are to be plotted and that no output has.
std::vector<std::string> missing_measures(const Experiment& experiment, const std::vector<Estimate>& estimates);

/// What the measures of an experiment are, as far as its graphs say.
std::vector<Meaning> meanings(const Experiment& experiment, const std::vector<Graph>& graphs,
                              const std::vector<TrialResult>& results);

/// Scores, plots and clips beside each other, part of a page from which the experiment's files are seen in `folder`
/// ("table-6-1/"; empty: beside the page).
std::string html_results(const Experiment& experiment, const std::vector<Graph>& graphs,
                         const std::vector<TrialResult>& results, const std::string& folder);

/// The page that compares the trials: scores, plots, clips beside each other, what differed, how each trial went.
std::string experiment_page(const Experiment& experiment, const std::vector<Graph>& graphs,
                            const std::vector<TrialResult>& results);

/// Makes the folder of an experiment and notes in experiment.json which file it is of. Throws std::invalid_argument if
/// the folder holds anything else than results of that file, unless it may be overwritten.
void claim_folder(const std::filesystem::path& folder, const std::filesystem::path& file, bool overwrite);

/// Writes to the experiment's folder, each file whole or not at all:
///   results.csv, results.json  one line a number
///   means.csv                  means with deviations and 95 % confidence intervals
///   plots/OUTPUT.svg
///   experiment.html            the page
void write_results(const Experiment& experiment, const std::vector<Graph>& graphs,
                   const std::vector<TrialResult>& results, const std::filesystem::path& folder);

}  // namespace talkgraph
