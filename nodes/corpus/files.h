#pragma once

#include <string>
#include <vector>

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// Speech files without pictures, to let a face speak them. The id of each is its file
/// name without ending; a repeated one gets "-2", "-3". Throws std::invalid_argument if there are
/// transcripts but not one for each file, std::runtime_error for a file that is missing.
struct SoundFiles {
  std::vector<FilePath> files;
  std::vector<std::string> transcripts;  ///< one a file, in order; an empty one is not known

  Stream<Recording> operator()() const;
};
void describe(Description<SoundFiles>& d);

}  // namespace talkgraph
