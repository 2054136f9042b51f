#pragma once

#include <string>

#include "annotate/project.h"

namespace talkgraph::cli {

struct AnnotateCommand {
  annotate::ProjectOptions project;
  int port = 8017;  ///< 0: any free one
};

/// `talkgraph annotate`: serves the page on which a person annotates frames, until Ctrl-C. Its address goes to stdout,
/// all else to stderr.
int run_annotate(const std::string& manifest, const AnnotateCommand& command);

}  // namespace talkgraph::cli
