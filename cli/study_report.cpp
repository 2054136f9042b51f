#include "cli/study_report.h"

#include <fmt/format.h>

#include "cli/run.h"
#include "study/report.h"
#include "study/store.h"

namespace talkgraph::cli {

int run_study_report(const std::filesystem::path& folder, const StudyReportCommand& command) {
  const auto study = study::read_study(folder);
  const auto output = command.output.empty() ? folder / "report" : command.output;
  study::write_report(study, study::read_answers(folder), command.options, output);
  fmt::print("{}\n", (output / "report.html").string());
  return success;
}

}  // namespace talkgraph::cli
