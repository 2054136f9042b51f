#include "cli/study_make.h"

#include <fmt/format.h>

#include <cstdio>

#include "study/make.h"

namespace talkgraph::cli {
namespace {

/// A run ended early; that has been said.
struct Ended {
  ExitCode code;
};

}  // namespace

int run_study_make(const StudyMakeCommand& command, const RunCommand& run, const Registry& registry) try {
  Diagnostics diagnostics;
  const auto run_below = [&](const Graph& graph, const std::filesystem::path& folder) {
    RunCommand below = run;
    below.folder = folder;
    auto outcome = run_graph(graph, below);
    if (outcome.code != success) throw Ended{outcome.code};
    return *std::move(outcome.result);
  };
  const auto design = study::load_design(command.design, diagnostics);
  const auto made = design ? study::make_study(*design, command.runs, command.folder, registry, run_below, diagnostics)
                           : std::nullopt;
  if (!made) return fmt::print(stderr, "{}\n", diagnostics.str()), usage;
  for (const auto& note : made->notes) fmt::print(stderr, "{}\n", note);
  for (const auto& test : made->study.tests)
    fmt::print(stderr, "{}: {} clips, of each category {} to a person\n", test.id, test.clips.size(),
               test.per_category);
  fmt::print("{}\n", command.folder.string());
  return success;
} catch (const Ended& ended) {
  return ended.code;
}

}  // namespace talkgraph::cli
