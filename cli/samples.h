#pragma once

#include <filesystem>

#include "cli/run.h"

namespace talkgraph::cli {

/// `talkgraph samples`: writes what the examples of reading nodes read, made by the built-in speaker: sound/, clips/,
/// manifest.json, grid/ (as the corpus lies on disk), model.h5.
int write_samples(RunCommand command, const Registry& registry);

}  // namespace talkgraph::cli
