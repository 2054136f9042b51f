#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "graph/archive.h"
#include "graph/context.h"
#include "graph/key.h"

namespace talkgraph {

/// Unfinished training of one model on disk.
class Checkpoint {
 public:
  /// `of` gives what stands for all that the training depends on, `fields` visits where it is. No folder: nothing is
  /// saved, and `of` is not asked.
  Checkpoint(const std::string& folder, const std::function<Key()>& of, std::function<void(Archive&)> fields);

  /// False where there is none, or only one that cannot be read, which is removed with a warning; what `fields` visits
  /// may be partly filled then.
  bool load(const std::string& subject, const Context& context);
  /// Between steps: saves at most every ten seconds, and where the run is cancelled. Throws Cancelled then.
  void between_steps(const Context& context);
  void remove();

 private:
  void save();

  std::filesystem::path path_;
  std::function<void(Archive&)> fields_;
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
};

}  // namespace talkgraph
