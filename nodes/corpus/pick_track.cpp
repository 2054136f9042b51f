#include "nodes/corpus/pick_track.h"

#include <algorithm>

namespace talkgraph {

std::optional<Track> PickTrack::operator()(const Track& track, Context& context) const {
  if (std::find(ids.begin(), ids.end(), context.item) == ids.end()) return {};
  return track;
}

void describe(Description<PickTrack>& d) {
  d.type("corpus.pick_track")
      .summary("lets the tracks of recordings of some names pass, after what was computed of all");
  d.input("track", "of any recording").output("track", "the same; nothing where the recording has another name");
  d.param("ids", &PickTrack::ids).doc("names");
}

}  // namespace talkgraph
