#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graph/json.h"
#include "graph/rational.h"

namespace talkgraph {

/// What `talkgraph corpus new` is told.
struct NewManifest {
  double validation = 0.1, test = 0.1;  ///< share of the clips, evenly spread; of fewer than 10 clips none
  std::optional<Rational> rate;         ///< of folders of pictures

  struct Out {
    Json manifest;
    std::vector<std::string> notes;  ///< what was passed over, and why
  };
  /// A manifest (docs/manifest.md) of the videos, and folders of pictures with sound beside them, in a folder and its
  /// subfolders. What lies beside a clip under its name is taken along: sound (.wav, .flac, .ogg), landmarks (.csv, or
  /// a folder NAME-landmarks of .pts), transcript (.txt, or .lab without times), words and phones (.TextGrid, .lab,
  /// .align; whether labels are phones tells which). File names are relative to `folder`. Ids are the clips'
  /// names, made fit and unique (nodes/corpus/ids.h). Throws std::runtime_error if the folder is not there or holds no
  /// clip.
  Out operator()(const std::filesystem::path& folder) const;
};

}  // namespace talkgraph
