#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/results.h"

namespace talkgraph {

/// Experiments that tell a story together: a page has sections, and each of them the results of some experiments.
struct ExperimentSeries {
  struct Part {
    Experiment experiment;
    std::vector<Graph> graphs;  ///< one a trial
    std::vector<TrialResult> results;
  };
  /// A table of texts that the file itself gives.
  struct Words {
    std::vector<std::string> columns;
    std::vector<std::pair<std::string, std::vector<std::string>>> rows;
  };
  struct Section {
    std::string title, text;
    Words words;
    std::vector<Part> parts;
  };
  std::string name;  ///< of the file, without its ending
  std::string description;
  std::vector<Section> sections;
};

/// Whether the file, as far as it can be read, is a series and no single experiment.
bool is_series(const std::filesystem::path& file);

/// Reads a series and all its experiments (docs/experiments.md). Each of `sets` is for those whose graphs have what it
/// sets. All that is wrong goes to `diagnostics`; nothing is returned then.
std::optional<ExperimentSeries> load_series(const std::filesystem::path& file, const Registry& registry,
                                            const std::vector<std::string>& sets, Diagnostics& diagnostics);

/// The page of all results, of which those of an experiment are in the folder of its name beside it.
std::string series_page(const ExperimentSeries& series);

}  // namespace talkgraph
