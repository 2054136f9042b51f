#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Phones of speech whose words are not known, by PocketSphinx's loop of
/// context-independent phones with its phone bigram. Most are wrong, 57 % of the time of speech on
/// GRID s1 (pipelines/phones-grid-s1.json): it is a stopgap, and says so in the log. Known phones (from
/// phones.align) are passed on.
///
/// The result covers the whole sound without gaps; digital silence and sound
/// shorter than 50 ms give one "sil".
struct Recognise {
  PhoneTrack operator()(const Audio& audio, const PhoneTrack* known, Context& context) const;
};
void describe(Description<Recognise>& d);

}  // namespace talkgraph
