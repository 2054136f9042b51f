#pragma once

#include <string>
#include <vector>

#include "study/findings.h"

namespace talkgraph::study {

/// A figure that stands for a measure.
struct Headline {
  std::string figure;  ///< "41 %"
  std::string text;    ///< "of synthetic clips were taken for real"
  std::string beside;  ///< "of real ones 72 %; chance is 50 %"
};
/// One a measure that has answers.
std::vector<Headline> headlines(const Findings& findings);

/// What a test found, in plain sentences; also where there is too little to find anything.
struct Chapter {
  std::string title;
  std::vector<std::string> sentences;
};
/// One a test.
std::vector<Chapter> story(const Findings& findings);

/// Who took part, when, and whose answers count.
std::string about_people(const Findings& findings, const Answers& answers);

/// As papers put it: "p < 0.001", "p < 0.01", "p < 0.05", else the largest hundredth below, "p > 0.13"; "–" of NaN.
std::string p_text(double p);
/// A mean score: "41 %", or "3.72".
std::string score_text(double score, const Measure& measure);
/// What is measured: "taken for real", "read right", or the question's name.
std::string measure_text(const Measure& measure);
/// With a capital letter in front.
std::string capital(std::string text);

}  // namespace talkgraph::study
