#pragma once

#include <string>
#include <vector>

#include "nodes/types/phones.h"

namespace talkgraph {

/// A phone label as all of talkgraph writes it: lower case without stress digits;
/// "sil" for the silences of other conventions (sil, sp, pau, spn, #, h#, <p:>, _ and empty).
std::string normalised_phone(const std::string& label);

/// Labels with times from a file, by its ending: .lab (HTK, 100 ns), .TextGrid
/// (Praat, long or short text format, UTF-8 or UTF-16; the tier named `tier` or
/// "...- tier", else the only interval tier), .align (GRID: 1/25000 s). Throws
/// std::runtime_error with file and line on anything malformed, out of order or
/// overlapping.
std::vector<Interval> read_intervals(const std::string& path, const std::string& tier);

/// Phones, normalised; gaps become "sil", neighbouring silences are joined, the
/// first phone starts at 0. What is no CMU or BEEP phone is refused.
PhoneTrack read_phones(const std::string& path);

/// Words in lower case; pauses (as in normalised_phone) become "sil".
WordTrack read_words(const std::string& path);

/// Word times of GRID: lines "start end word" in 1/25000 s.
std::vector<Interval> parse_grid_align(const std::string& text, const std::string& name);

/// The words in order without the pauses.
Transcript transcript_of(const WordTrack& words);

}  // namespace talkgraph
