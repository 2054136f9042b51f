#pragma once

#include <string>
#include <vector>

#include "nodes/voice/voice.h"

namespace talkgraph::espeak {

/// The start of a phoneme, or of a pause ("_:").
struct Phoneme {
  std::string name;
  std::int64_t sample = 0;
  bool starts_word = false;
};

struct Spoken {
  Eigen::VectorXd samples;
  double rate = 22050;
  std::vector<Phoneme> phonemes;
};

/// The library behind its lock; every function throws std::runtime_error if it
/// was switched off at build time.
Spoken synthesise(const std::string& text, const Voice& voice);

/// Names of the phonemes of a text, without stress and pauses.
std::vector<std::string> phonemes(const std::string& text);

}  // namespace talkgraph::espeak
