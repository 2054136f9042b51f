#pragma once

#include <filesystem>

#include "study/findings.h"

namespace talkgraph::cli {

struct StudyReportCommand {
  study::FindingOptions options;
  std::filesystem::path output;  ///< empty: report/ in the study's folder
};

/// `talkgraph study report`: writes what people answered so far, also while the study is served. The page is named on
/// stdout.
int run_study_report(const std::filesystem::path& folder, const StudyReportCommand& command);

}  // namespace talkgraph::cli
