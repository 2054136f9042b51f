#include "nodes/corpus/select.h"

#include <algorithm>

namespace talkgraph {

std::optional<Recording> Select::operator()(const Recording& recording) const {
  if (!splits.empty() && std::find(splits.begin(), splits.end(), recording.split) == splits.end()) return {};
  return recording;
}

void describe(Description<Select>& d) {
  d.type("corpus.select").summary("lets recordings of some splits pass");
  d.input("recording", "of any split").output("recording", "the same; nothing where it is of another split");
  d.param("splits", &Select::splits).doc("names of splits (\"train\", \"validation\", \"test\"); empty: all");
}

}  // namespace talkgraph
