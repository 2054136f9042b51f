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
  /// `of` stands for all that the training depends on, `fields` for where it is. No folder: nothing is saved.
  Checkpoint(const std::string& folder, const Key& of, std::function<void(Archive&)> fields);

  /// False where there is none, or only one that cannot be read, which is removed with a warning; what `fields` visits
  /// may be partly filled then.
  bool load(const std::string& subject, const Context& context);
  /// Saves at most every ten seconds.
  void save_now_and_then();
  void save();
  void remove();

 private:
  std::filesystem::path path_;
  std::function<void(Archive&)> fields_;
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
};

}  // namespace talkgraph
