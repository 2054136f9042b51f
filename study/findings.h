#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "nodes/statistics/correction.h"
#include "nodes/statistics/rank_sum.h"
#include "study/scores.h"

namespace talkgraph::study {

struct FindingOptions {
  bool finished_only = false;  ///< else every answer counts, however far who gave it came
  Correction correction = Correction::holm;
  double confidence = 0.95;
};

/// People's mean scores of clips of two kinds, or those of two groups of people.
struct Comparison {
  enum class Kind {
    clips,            ///< real against synthetic
    clips_in_groups,  ///< the same within a group of people
    eyes,             ///< recorded against static
    groups,           ///< one group of people against another
    plays,            ///< clips seen once against those replayed
  };
  Kind kind = Kind::clips;
  std::size_t measure = 0;  ///< in Findings::measures
  std::string of;           ///< what both are: "LIPS style, static eyes"
  std::string first_name, second_name;
  Means first, second;

  /// Wilcoxon's rank-sum test, which takes the two as independent; p is NaN where one has fewer than two people.
  RankSum test;
  /// Of Wilcoxon's signed-rank test over the people who are in both; NaN if they are fewer than two.
  double p_paired = NAN;
  /// Corrected over all comparisons of this kind in the same test of the study.
  double p_corrected = NAN, p_paired_corrected = NAN;

  double difference() const;  ///< of the means, the first less the second
};

/// What people answered, compared. Points into the study, which outlives it.
struct Findings {
  const Study* study = nullptr;
  FindingOptions options;
  std::size_t took_part = 0, finished = 0;
  std::vector<Participant> people;      ///< whose answers count: all who gave one, or of them those who finished
  std::vector<Measure> measures;        ///< of these answers
  std::vector<Comparison> comparisons;  ///< by measure, then by kind

  bool differs(const Comparison& c) const { return c.p_corrected < 1 - options.confidence; }
};

/// Throws std::runtime_error as measures_of does.
Findings find(const Study& study, const Answers& answers, const FindingOptions& options = {});

/// Those of one kind and the same two names together.
std::vector<std::vector<Comparison>> tabled(const std::vector<Comparison>& comparisons);

/// A question of the profile by which people are grouped, or nullptr.
const Question* split_question(const Study& study);

}  // namespace talkgraph::study
