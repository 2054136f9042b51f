#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/forecast.h"

namespace talkgraph {

/// A run's dealings with the cache: what need not be called, and what is kept of what was.
class Keeper {
 public:
  /// `warn` is told, once, if results cannot be kept.
  Keeper(const Graph& graph, Cache& cache, std::filesystem::path folder, const std::atomic<bool>* cancel,
         std::function<void(std::string_view)> warn);

  Forecast& forecast() { return forecast_; }
  const Forecast& forecast() const { return forecast_; }

  /// Whether results of a node are kept.
  bool keeps(int node) const;
  /// For a call whose result is kept: waits while another run of this process makes the same.
  Cache::Claim claim(int node, const std::string& item) const;
  /// Whether the result is there by now, though the forecast did not see it.
  bool made_meanwhile(int node, const std::string& item) const;
  /// What the sink wrote whose result is kept, below the run folder.
  std::vector<std::string> files(int node, const std::string& item) const;
  /// Throws Cache::Damaged.
  Cache::Result load(int node, const std::string& item) const;
  /// Keeps a result; `written` holds what a sink wrote, or is empty. Gives its bytes on disk: 0 if it cannot be kept,
  /// which is not an error of the run.
  std::uint64_t keep(int node, const std::string& item, const Cache::Result& result,
                     const std::filesystem::path& written);

 private:
  void give_up(const std::string& why);

  const Graph& graph_;
  Cache& cache_;
  const std::filesystem::path folder_;
  Forecast forecast_;
  std::function<void(std::string_view)> warn_;
  std::atomic<bool> full_{false};
  std::atomic<bool> changed_{false};
};

}  // namespace talkgraph
