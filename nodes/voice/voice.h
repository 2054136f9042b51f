#pragma once

#include <string>
#include <vector>

#include "nodes/types/audio.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// How espeak-ng shall sound.
struct Voice {
  /// A voice of espeak-ng that speaks English: "en-us", "en-us+f3". Voices
  /// with flutter or breath, unlike this one, sound a little different every time.
  std::string name = "en-us+michel";
  double rate = 165;    ///< words per minute, 80 to 450
  double pitch = 50;    ///< 0 to 100
  double volume = 100;  ///< 0 to 200; sound above 100 may clip
};

/// Speech with what is said in it. Phones and words cover the whole sound
/// without gaps, "sil" in pauses; words are in lower case.
struct Utterance {
  Audio audio;  ///< 22050 Hz
  PhoneTrack phones;
  WordTrack words;
};

/// Speaks English text through espeak-ng. May be called from any thread; calls wait for each other. Throws
/// std::invalid_argument if the voice is unknown, its numbers are out of range
/// or nothing in the text can be spoken; std::runtime_error if espeak-ng was
/// switched off at build time, its data are missing, or it speaks a phoneme
/// that has no CMU phone.
Utterance speak(const std::string& text, const Voice& voice);

/// CMU phones, without stress, of one English word, as espeak-ng says it.
/// Empty if the word has nothing to say ("-"). Throws like `speak`.
std::vector<std::string> pronounce(const std::string& word);

/// CMU phones of an espeak-ng phoneme of American English: one, or two for
/// vowels coloured by r; none for a pause or a mere glide. Throws std::runtime_error on one
/// that is not known.
std::vector<std::string> cmu_phones(const std::string& espeak_phoneme);

}  // namespace talkgraph
