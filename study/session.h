#pragma once

#include <cstdint>
#include <vector>

#include "study/study.h"

namespace talkgraph::study {

/// A clip as one person comes to see it; refers to the study.
struct Showing {
  const Test* test = nullptr;
  const Clip* clip = nullptr;
  int position = 0;  ///< in its test, from 0
};

/// All that one person is shown, in order: the tests in random order, in each `per_category` clips of every category
/// (all, where there are fewer), drawn and ordered at random. The same seed gives the same on every machine.
std::vector<Showing> plan(const Study& study, std::uint64_t seed);

/// Questions about a clip with the options it has: those of the question or, of an intelligibility test, its sentences.
const std::vector<std::string>& options(const Question& question, const Clip& clip);

}  // namespace talkgraph::study
