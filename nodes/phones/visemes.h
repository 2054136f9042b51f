#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Phones as MPEG-4 visemes: labels "1" to "14", or "sil". Adjoining stretches of one
/// viseme stay apart, as their phones are. Throws std::runtime_error on what is no phone.
struct ToVisemes {
  PhoneTrack operator()(const PhoneTrack& phones) const;
};
void describe(Description<ToVisemes>& d);

}  // namespace talkgraph
