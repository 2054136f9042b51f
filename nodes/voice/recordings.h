#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/recording.h"
#include "nodes/voice/voice.h"

namespace talkgraph {

/// A recording of speech for each text, without pictures: "text-1", "text-2" ...
/// Errors as of talkgraph::speak; std::invalid_argument without texts.
struct SpokenRecordings {
  std::vector<std::string> texts;
  Voice voice;

  Stream<Recording> operator()() const;
};
void describe(Description<SpokenRecordings>& d);

}  // namespace talkgraph
