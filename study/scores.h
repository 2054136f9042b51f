#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "study/answers.h"
#include "study/study.h"

namespace talkgraph::study {

/// An answer as a number. Points into the study, which outlives it.
struct Score {
  const Test* test = nullptr;
  const Question* question = nullptr;
  const Clip* clip = nullptr;
  std::int64_t participant = 0;
  int option = 0, plays = 0;
  double seconds = 0;
  double value = 0;  ///< 1 where the clip was taken for real, or read right, else 0; a step of a scale, from 1
};

/// Throws std::runtime_error if the study has no such question, clip or option.
Score score_of(const Study& study, const Answer& answer);

/// What one question of a test measures.
struct Measure {
  const Test* test = nullptr;
  const Question* question = nullptr;
  std::vector<Score> scores;

  bool is_share() const { return test->kind != TestKind::perceptual; }
  double most() const;    ///< the highest score there is
  double chance() const;  ///< mean score of who guesses; NaN on a scale
};

/// A measure a question of a test, in the study's order. Throws std::runtime_error on an answer of nobody who took
/// part, to a clip, question or option that is not there, or given twice.
std::vector<Measure> measures_of(const Study& study, const Answers& answers);

/// The mean score of each participant, by whose number.
using Means = std::map<std::int64_t, double>;
Means means_of(const std::vector<Score>& scores);
std::vector<double> values_of(const Means& means);

/// "too_fast" as people read it: "too fast".
std::string plain_name(std::string id);

/// How many of a test's clips a participant is shown.
std::size_t clips_shown(const Test& test);

/// The option of a question of the profile, or -1 where it was not answered, or not to be said.
int profile_option(const Question& question, const Participant& participant);

}  // namespace talkgraph::study
