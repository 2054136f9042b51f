#pragma once

#include <filesystem>

#include "study/answers.h"
#include "study/findings.h"

namespace talkgraph::study {

/// Writes report.html with what was found, plots/NAME.svg, every answer as answers.csv and answers.json (also of people
/// who do not count in the report), and all tables as summary.csv and summary.json. Throws std::runtime_error as find
/// does, or where a file cannot be written.
void write_report(const Study& study, const Answers& answers, const FindingOptions& options,
                  const std::filesystem::path& folder);

}  // namespace talkgraph::study
