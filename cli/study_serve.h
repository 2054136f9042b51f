#pragma once

#include <string>

#include "study/server.h"

namespace talkgraph::cli {

struct StudyServeCommand {
  study::ServerOptions server;
  int invite = 0;  ///< so many links, each for one person
};

/// `talkgraph study serve`: serves the page on which people take a study, until Ctrl-C. Links go to stdout, a line each
/// after what it is for; all else to stderr.
int run_study_serve(const std::string& folder, StudyServeCommand command);

}  // namespace talkgraph::cli
