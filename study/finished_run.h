#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "graph/registry.h"
#include "study/choose.h"
#include "study/make.h"

namespace talkgraph::study {

/// A run that came to its end, by its folder.
class FinishedRun {
 public:
  /// Throws std::runtime_error that names the folder if it holds no run, or one that did not finish or has failures.
  explicit FinishedRun(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  /// That of the run's report, else the folder's name.
  const std::string& title() const { return title_; }

  /// Finds the ports in the run's graph; complaints name the place in the design.
  bool find(const Design& design, const Registry& registry, Diagnostics& diagnostics);
  /// What the run has to show. Throws std::runtime_error if that is nothing.
  Speaker speaker(const Registry& registry, const RunGraph& run, const std::filesystem::path& desk) const;
  /// Draws the clips of this speaker, desk/clips/ID.webm and ID.mp4.
  void draw(const Design& design, const Study& study, const std::string& speaker, const Registry& registry,
            const RunGraph& run, const std::filesystem::path& desk) const;

 private:
  Graph load(Json nodes, const Json& outputs, const Registry& registry) const;
  Json needed(const std::vector<std::string>& ports) const;

  std::filesystem::path folder_;
  std::string title_;
  Json graph_;
  Ports ports_;  ///< outputs of the run's graph
};

}  // namespace talkgraph::study
