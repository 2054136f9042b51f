#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "graph/provenance.h"

namespace talkgraph {

/// Thrown out of a node by Context::check_cancelled.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

/// What a running node may know of its surroundings; a node asks for it as a
/// further argument `Context&` of its call operator. A default-constructed one
/// serves in tests: it tells nobody and writes below the working directory.
class Context {
 public:
  std::string item;                         ///< key of the item, empty for a node that runs once
  std::filesystem::path folder = ".";       ///< the run folder, or where its files are put together
  Provenance provenance;                    ///< only for a node that asks for it
  std::function<void(double)> on_progress;  ///< share done, 0..1
  std::function<void(std::string_view)> on_log;
  std::function<void(std::string_view)> on_warning;
  const std::atomic<bool>* cancel = nullptr;  ///< the user wants the run to end
  const std::atomic<bool>* stop = nullptr;    ///< the run ends, as another node failed

  /// Where a node writes a file. Throws std::invalid_argument if `path` leads out of the run folder.
  std::filesystem::path file(const std::filesystem::path& path) const {
    if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
      throw std::invalid_argument("\"" + path.string() +
                                  "\" is not below the run folder: leave out a leading \"/\" and \"..\"");
    return folder / path;
  }
  void progress(double share) const {
    if (on_progress) on_progress(share);
  }
  void log(std::string_view message) const {
    if (on_log) on_log(message);
  }
  /// Tells the user of what may make the result worse than it looks.
  void warn(std::string_view message) const {
    if (on_warning) on_warning(message);
  }
  bool cancelled() const { return is_set(cancel) || is_set(stop); }
  /// Long loops call this now and then.
  void check_cancelled() const {
    if (cancelled()) throw Cancelled();
  }

 private:
  static bool is_set(const std::atomic<bool>* flag) { return flag && flag->load(std::memory_order_relaxed); }
};

}  // namespace talkgraph
