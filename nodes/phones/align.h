#pragma once

#include <optional>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// Where the phones and words of an utterance are.
struct Alignment {
  PhoneTrack phones;
  WordTrack words;
};

/// Times of the phones of known words, by forced alignment with PocketSphinx
/// and its en-us model: a word search over the words in their order with
/// optional pauses and alternative pronunciations, then a state alignment of
/// the pronunciations found, then boundaries moved to where the spectrum changes
/// (nodes/phones/boundaries.h). Sound of any rate is resampled to 16 kHz. Words
/// outside the dictionary are pronounced by espeak-ng.
///
/// Phones given with the corpus are passed on, with the word track, if there is one.
/// The words come from the transcript, else from the word track (its times are not used).
/// With neither the item is dropped: see phones.recognise.
///
/// Both tracks cover the whole sound without gaps, "sil" in pauses; words are spelled as they
/// are spoken ("1984" is three words). A word track without words gives one "sil".
/// Speech in a pause, which the words lack, is warned about with the place, and is an error where it is long.
/// Errors: words that do not go with the sound, or do not fit into it, with the
/// place; words for digital silence or for less than 50 ms; a transcript without
/// words.
struct Align {
  double mismatch = 52;    ///< how far five seconds of words may be from the sound: see describe
  double unwritten = 0.5;  ///< speech that the transcript lacks in one pause, seconds

  std::optional<Alignment> operator()(const Audio& audio, const Transcript* transcript, const WordTrack* words,
                                      const PhoneTrack* given, Context& context) const;
};
void describe(Description<Align>& d);

}  // namespace talkgraph
