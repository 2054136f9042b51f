#include "cli/study_serve.h"

#include <fmt/format.h>

#include <cstdio>

#include "cli/run.h"
#include "cli/signals.h"

namespace talkgraph::cli {

int run_study_serve(const std::string& folder, StudyServeCommand command) {
  const InterruptGuard guard;
  command.server.warn = [](const std::string& message) { fmt::print(stderr, "warning: {}\n", message); };
  study::Server server(folder, command.server);
  fmt::print(stderr, "every answer is kept in {}/answers.db; Ctrl-C ends\n", folder);
  fmt::print("start   {}\nreport  {}\n", server.start_url(), server.report_url());
  for (int i = 0; i < command.invite; ++i) fmt::print("invite  {}\n", server.invite());
  std::fflush(stdout);
  server.run(*guard.flag());
  return success;
}

}  // namespace talkgraph::cli
