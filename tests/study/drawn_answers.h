#pragma once

#include <functional>

#include "graph/random.h"
#include "study/answers.h"
#include "study/study.h"

namespace talkgraph::study::test {

/// A study of the published size: LIPS and DEMNOW; 16 of 60 clips real or synthetic, 24 clips rated by three questions
/// with recorded and static eyes, 12 of 60 clips lip-read.
Study full_study();

/// How simulated people answer.
struct Behaviour {
  /// Chance to take a clip for real or read it right, or the mean opinion.
  std::function<double(const Test&, const Question&, const Clip&, bool native)> mean;
  double leaning = 0.5;  ///< deviation of people's means of opinions
  double noise = 0.7;    ///< deviation of an opinion around its mean
  double native = 0.3;   ///< share of people
  double replay = 0.3;   ///< chance of each further play
  double give_up = 0;    ///< chance to stop at each clip
};

/// Means like those of the published study (Turing test, Tables 6.6 and 6.7).
double published_mean(const Test& test, const Question& question, const Clip& clip, bool native);

Answers simulate(const Study& study, const Behaviour& behaviour, int people, Random& random);

}  // namespace talkgraph::study::test
