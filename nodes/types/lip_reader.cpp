#include "nodes/types/lip_reader.h"

#include <algorithm>

#include "nodes/types/stored_model.h"

namespace talkgraph {

void fields(Archive& ar, LipReader& r) {
  ar("units", r.units);
  ar("unit_of", r.unit_of);
  ar("visemes", r.visemes);
  ar("network", r.network);
  if (!ar.loading()) return;
  const StoredModel stored("lip reader");
  stored.require(std::ssize(r.unit_of) == r.network.states(), "unit_of", "is not one number a state");
  stored.require(std::all_of(r.unit_of.begin(), r.unit_of.end(),
                             [&](std::int64_t u) { return u >= 0 && u < std::ssize(r.units); }),
                 "unit_of", "names units that are not there");
}

}  // namespace talkgraph
