#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace talkgraph {

/// A stretch of frames [start, end) of 10 ms with what PocketSphinx calls it.
struct FrameSpan {
  std::string label;
  int start = 0;
  int end = 0;
  double score = 0;  ///< acoustic log likelihood a frame, relative to the best unit of the frame (at most 0)
};

/// Samples are taken at this rate, 16 bits.
inline constexpr double kSphinxRate = 16000;
inline constexpr int kSphinxHop = 160;  ///< samples from frame to frame

/// Whether a word or a phone is a pause or a noise.
bool is_filler(const FrameSpan& span);

/// Time of the boundary before a frame: half a window less half a hop after the frame's first sample.
inline double sphinx_boundary(int frame) { return 0.010 * frame + 0.0078; }

/// A PocketSphinx decoder with the packaged en-us model, for forced alignment.
/// For one thread at a time; what it returns does not depend on what it did
/// before. Throws std::runtime_error if the model is not installed or the
/// library is not the one whose state aligner is known here.
class SphinxAligner {
 public:
  SphinxAligner();
  ~SphinxAligner();
  SphinxAligner(const SphinxAligner&) = delete;

  /// Whether the dictionary holds the word (lower case).
  bool knows(const std::string& word) const;
  /// Its phones as the dictionary has them first, "HH", "AH" ...; none if it does not hold the word.
  std::vector<std::string> pronunciation(const std::string& word) const;
  /// Adds a word with its CMU phones ("hh", "ah", ...).
  void learn(const std::string& word, const std::vector<std::string>& phones);

  struct Result {
    std::vector<FrameSpan> words;   ///< in order, fillers such as "<sil>" included
    std::vector<FrameSpan> phones;  ///< without gaps, labels as in the model: "AH", "SIL", "+NSN+"
  };
  /// Aligns known words to sound of any length: long sound is searched in windows of a
  /// minute, each of which begins where the one before has an anchor. The words of the
  /// result stop early (phones empty) where the words do not go into the sound.
  Result align(std::span<const std::int16_t> sound, const std::vector<std::string>& words);

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

/// A PocketSphinx decoder that takes any phone after any other, weighted by the
/// packaged phone bigram. For one thread at a time.
class SphinxPhoneLoop {
 public:
  SphinxPhoneLoop();
  ~SphinxPhoneLoop();
  SphinxPhoneLoop(const SphinxPhoneLoop&) = delete;

  /// Sound of any length, in windows as SphinxAligner has them.
  std::vector<FrameSpan> decode(std::span<const std::int16_t> sound);

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace talkgraph
