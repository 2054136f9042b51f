#include "nodes/corpus/faults.h"

#include <fmt/format.h>

namespace talkgraph {

std::string faults_text(const Recording& recording) {
  std::string text;
  for (const auto& fault : recording.faults)
    text += fmt::format("{}clip \"{}\": {}", text.empty() ? "" : "\n", recording.id, fault);
  return text;
}

void refuse_faults(const Recording& recording) {
  if (!recording.faults.empty()) throw std::runtime_error(faults_text(recording));
}

}  // namespace talkgraph
