#include "nodes/write/track.h"

#include "graph/output_file.h"
#include "nodes/types/item_file.h"
#include "nodes/write/text.h"

namespace talkgraph {

Artifact WriteTrack::operator()(const Track& track, const Track* named, Context& context) const {
  Track out = track;
  if (named && std::ssize(named->names) == track.dimension()) out.names = named->names;
  Artifact file = item_file(context, folder, ".csv", "track");
  write_file(context.file(file.path), to_csv(out));
  return file;
}

void describe(Description<WriteTrack>& d) {
  d.type("write.track").summary("writes a track as CSV, a line a frame").sink();
  d.input("track", "what is written")
      .input("named", "a track that names the dimensions")
      .output("file", "the CSV file");
  d.param("folder", &WriteTrack::folder).doc("below the run folder");
}

}  // namespace talkgraph
