#pragma once

#include <optional>

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Times of the phones of known words, by forced alignment with PocketSphinx
/// and its en-us model: a word search over the words in their order with
/// optional pauses and alternative pronunciations, then a state alignment of
/// the pronunciations found. Sound of any rate is resampled to 16 kHz. Words
/// outside the dictionary are pronounced by espeak-ng.
///
/// Phones given with the corpus are passed on. The words come from the
/// transcript, else from the word track (its times are not used). With neither
/// the item is dropped: see phones.recognise.
///
/// The result covers the whole sound without gaps. A word track without words gives one "sil".
/// Errors: words that do not go with the sound, or do not fit into it, with the
/// place; words for digital silence or for less than 50 ms; a transcript without
/// words; sound longer than 5 minutes.
struct Align {
  double mismatch = 50;  ///< how unlike their sound three seconds of words may be: a distance per frame

  std::optional<PhoneTrack> operator()(const Audio& audio, const Transcript* transcript, const WordTrack* words,
                                       const PhoneTrack* given) const;
};
void describe(Description<Align>& d);

}  // namespace talkgraph
