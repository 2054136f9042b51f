#pragma once

#include <string>
#include <utility>
#include <vector>

#include "nodes/types/report.h"
#include "study/findings.h"

namespace talkgraph::study {

/// A plot a test, by its name, and "study.replays".
std::vector<std::pair<std::string, Plot>> plots_of(const Findings& findings);

/// One page that needs no other file: what was found, in words and figures, then plots and tables, then how it was
/// computed.
std::string report_page(const Findings& findings, const Answers& answers);

}  // namespace talkgraph::study
