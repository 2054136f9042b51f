#include "nodes/corpus/pick.h"

#include <algorithm>

namespace talkgraph {

std::optional<Recording> Pick::operator()(const Recording& recording) const {
  if (std::find(ids.begin(), ids.end(), recording.id) == ids.end()) return {};
  return recording;
}

void describe(Description<Pick>& d) {
  d.type("corpus.pick").summary("lets the recordings of some names pass");
  d.input("recording", "of any name").output("recording", "the same; nothing where it has another name");
  d.param("ids", &Pick::ids).doc("names; one that no recording has is passed over");
}

}  // namespace talkgraph
