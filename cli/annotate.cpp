#include "cli/annotate.h"

#include <fmt/format.h>

#include <cstdio>

#include "annotate/server.h"
#include "cli/run.h"
#include "cli/signals.h"

namespace talkgraph::cli {

int run_annotate(const std::string& manifest, const AnnotateCommand& command) {
  Diagnostics diagnostics;
  const auto project = annotate::Project::open(manifest, command.project, diagnostics);
  if (!project) {
    fmt::print(stderr, "{}\n", diagnostics.str());
    return usage;
  }
  const InterruptGuard guard;
  annotate::Server server(*project, command.port);
  project->tell_manifest();
  fmt::print(stderr, "{} frames to annotate; every change is kept in {}; Ctrl-C ends. Open this page:\n",
             project->frames().size(), project->folder().string());
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  server.run(*guard.flag());
  return success;
}

}  // namespace talkgraph::cli
