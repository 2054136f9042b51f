#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/design.h"

namespace talkgraph::study {

/// A recording that can be shown, as it was and as it is imitated.
struct Sequence {
  std::string id;
  std::string sentence;  ///< empty: nobody knows
  double seconds = 0;
};

/// What a run has to show.
struct Speaker {
  std::string title;
  std::vector<Sequence> sequences;
  std::vector<std::string> sentences;  ///< for false choices, besides those of the sequences
};

/// Chooses the clips of all tests, the same for the same seed. Each category (speaker × real or synthetic × eyes) of a
/// test gets as many sequences as a person sees of it, never one twice. Where there are enough, no sequence is used
/// again anywhere; where there are not, first between tests, then between the categories of a test. Sequences that are
/// left over then fill the pools, equally for all categories of a test; so pools never make a person see a sequence
/// twice. `notes` says what is used again. Complaints name the place in STUDY.json; nothing is returned then.
std::optional<Study> choose(const Design& design, const std::vector<Speaker>& speakers, std::vector<std::string>& notes,
                            Diagnostics& diagnostics);

/// Sentences of about the same length, each once whatever its case and punctuation, shortest first. The longest of a
/// group has a quarter more characters than the shortest, at most.
std::vector<std::vector<std::string>> by_length(const std::vector<std::string>& sentences);

}  // namespace talkgraph::study
