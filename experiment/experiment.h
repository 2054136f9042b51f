#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graph/graph.h"

namespace talkgraph {

/// One run of an experiment: the graph with some values changed.
struct Trial {
  std::string name;                  ///< "latent=2,seed=1": its folder; the same as long as its settings are
  std::vector<Json> levels;          ///< one a factor: a number, true or false, or a text
  std::size_t setting = 0;           ///< trials that differ in nothing but the seed share it
  std::optional<std::int64_t> seed;  ///< none: the graph's own
  std::vector<Change> changes;
};

/// Outputs of the graph that an experiment names.
struct NamedOutputs {
  std::vector<std::string> names;
  Place place;
};

/// An experiment file, with all its trials laid out.
struct Experiment {
  std::string name;  ///< of the file, without its ending
  std::string description;
  std::filesystem::path graph;
  Place vary, repeats;                  ///< where the factors stand, and the seeds
  std::vector<Change> set;              ///< of all runs, before their own changes
  std::map<std::string, Place> varied;  ///< what factors and seeds set, by whole paths, and where
  std::vector<std::string> factors;     ///< what varies
  std::vector<Trial> trials;
  std::size_t settings = 1;
  NamedOutputs tabulate;          ///< tables or scores
  std::vector<std::string> plot;  ///< measures of them; empty: all
  NamedOutputs show;              ///< clips or pictures for the page
};

/// Reads an experiment file (docs/experiments.md). All that is wrong goes to `diagnostics`; nothing is returned then.
std::optional<Experiment> load_experiment(const std::filesystem::path& file, Diagnostics& diagnostics);

/// Changes all runs by `sets`, as given to --set, in place of what the file's "set" has. It is an error, with the
/// factor's place, where the runs' own changes would replace what one sets.
void set_in_all_runs(Experiment& experiment, const std::vector<std::string>& sets, Diagnostics& diagnostics);

/// Whether something that the file sets in all runs is varied, whole or in part, in some.
bool varies(const Experiment& experiment, const Change& set);

/// Reads and checks the graph of a trial.
std::optional<Graph> load_trial(const Experiment& experiment, const Trial& trial, const Registry& registry,
                                Diagnostics& diagnostics);
/// Those of all trials, and that what is to be tabulated and shown is there to be. All that is wrong goes to
/// `diagnostics`, once; nothing is returned then.
std::optional<std::vector<Graph>> load_trials(const Experiment& experiment, const Registry& registry,
                                              Diagnostics& diagnostics);

/// The JSON Schema of experiment files, for editors.
Json experiment_schema();

}  // namespace talkgraph
