#pragma once

#include "graph/description.h"
#include "nodes/corpus/manifest_file.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// The pictures of a clip that has some. Throws std::runtime_error that names the file.
Video open_pictures(const ManifestClip& clip);

/// Any recordings, as a JSON file describes them: docs/manifest.md. Files it names are
/// taken from its own folder. Throws std::runtime_error: all that is wrong with the
/// manifest, and all files that it names and that are missing, in one go with
/// file:line:column when it starts; a malformed label, landmark or track file, with its
/// line, when its clip's turn comes. `lenient` leaves such a file out instead, and tells of it in Recording::faults.
struct Manifest {
  FilePath file;
  bool lenient = false;

  Stream<Recording> operator()() const;
};
void describe(Description<Manifest>& d);

}  // namespace talkgraph
