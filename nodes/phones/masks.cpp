#include "nodes/phones/masks.h"

#include <string_view>

#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

bool is_silent_word(std::string_view word) { return word == "sil" || word == "sp" || word.empty(); }

/// Stretches of speech in order, joined over pauses shorter than `pauses`.
std::vector<Interval> speech(const std::vector<Interval>& intervals, bool (*silent)(std::string_view), double pauses) {
  std::vector<Interval> stretches;
  for (const auto& interval : intervals) {
    if (silent(interval.label)) continue;
    if (!stretches.empty() && interval.start - stretches.back().end < pauses)
      stretches.back().end = interval.end;
    else
      stretches.push_back(interval);
  }
  return stretches;
}

/// A boundary at a frame's centre belongs to what begins there, whatever the rounding.
constexpr double kRounding = 1e-9;

Mask mask(const std::vector<Interval>& intervals, bool (*silent)(std::string_view), double pauses, const Track& like) {
  const auto stretches = speech(intervals, silent, pauses);
  Mask mask;
  std::size_t at = 0;
  for (Eigen::Index t = 0; t < like.frames(); ++t) {
    const double centre = like.time(t);
    while (at < stretches.size() && stretches[at].end <= centre + kRounding) ++at;
    mask.frames.push_back(at < stretches.size() && stretches[at].start <= centre + kRounding);
  }
  return mask;
}

constexpr std::string_view kPauses = "pauses inside speech that are shorter count as speech";

}  // namespace

Mask SpeechMask::operator()(const PhoneTrack& phones, const Track& like) const {
  return mask(phones.phones, is_pause, pauses, like);
}

Mask WordMask::operator()(const WordTrack& words, const Track& like) const {
  return mask(words.words, is_silent_word, pauses, like);
}

void describe(Description<SpeechMask>& d) {
  d.type("phones.speech_mask").summary("marks the frames whose centre lies in speech");
  d.input("phones", "with their times")
      .input("like", "the track whose frames are marked")
      .output("mask", "1 in speech, 0 elsewhere");
  d.param("pauses", &SpeechMask::pauses).at_least(0).unit("s").doc(std::string(kPauses));
}

void describe(Description<WordMask>& d) {
  d.type("phones.word_mask").summary("marks the frames whose centre lies in a word");
  d.input("words", "with their times")
      .input("like", "the track whose frames are marked")
      .output("mask", "1 in words, 0 elsewhere");
  d.param("pauses", &WordMask::pauses).at_least(0).unit("s").doc(std::string(kPauses));
}

}  // namespace talkgraph
