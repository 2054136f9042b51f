#include "nodes/phones/align.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "nodes/phones/decoder_pool.h"
#include "nodes/phones/pocketsphinx.h"
#include "nodes/phones/sound.h"
#include "nodes/phones/words.h"
#include "nodes/voice/voice.h"

namespace talkgraph {
namespace {

using Words = std::vector<std::string>;

Words known_words(const Transcript* transcript, const WordTrack* track) {
  if (transcript) return spoken_words(transcript->text);
  Words words;
  for (const auto& word : track->words) {
    if (word.label == "sil" || word.label == "sp") continue;
    for (auto& spoken : spoken_words(word.label)) words.push_back(std::move(spoken));
  }
  return words;
}

void learn_missing(SphinxAligner& aligner, const Words& words) {
  for (const auto& word : words) {
    if (aligner.knows(word)) continue;
    const auto phones = pronounce(word);
    if (phones.empty())
      throw std::runtime_error("phones.align: no pronunciation for \"" + word +
                               "\"; spell it in the transcript as it is said");
    aligner.learn(word, phones);
  }
}

std::vector<FrameSpan> without_fillers(std::vector<FrameSpan> words) {
  std::erase_if(words, is_filler);
  return words;
}

std::string quote(std::span<const std::string> words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return '"' + text + '"';
}

/// A run of words and how unlike the sound it is, as a distance per frame.
struct Stretch {
  std::size_t first = 0;
  std::size_t count = 0;
  double distance = 0;
};

/// The least likely run of words that together last three seconds, or the whole
/// where that is shorter.
Stretch worst_stretch(const std::vector<FrameSpan>& words) {
  constexpr int kFrames = 300;
  Stretch worst;
  for (std::size_t first = 0; first < words.size(); ++first) {
    int frames = 0;
    double score = 0;
    std::size_t end = first;
    for (; end < words.size() && frames < kFrames; ++end) {
      frames += words[end].end - words[end].start;
      score += words[end].score * (words[end].end - words[end].start);
    }
    if (frames < kFrames && first > 0) break;
    if (first == 0 || -score / frames > worst.distance) worst = {first, end - first, -score / frames};
  }
  return worst;
}

void check_fit(const SphinxAligner::Result& result, const Words& words, double mismatch) {
  const auto found = without_fillers(result.words);
  if (result.phones.empty()) {
    const std::size_t reached = std::min(found.size(), words.size() - 1);
    throw std::runtime_error(fmt::format(
        "phones.align: the {} words of the transcript do not fit into the sound: it ends in word {}, {}; check "
        "that transcript and sound belong together",
        words.size(), reached + 1, quote(std::span(words).subspan(reached, 1))));
  }
  const Stretch worst = worst_stretch(found);
  if (worst.distance <= mismatch) return;
  throw std::runtime_error(
      fmt::format("phones.align: the transcript does not match the sound: {} from {:.2f} s to {:.2f} s is unlike what "
                  "is said there "
                  "(distance {:.0f} per frame, at most {:g} is taken); correct the transcript, or leave it out to have "
                  "the phones recognised",
                  quote(std::span(words).subspan(worst.first, worst.count)), sphinx_boundary(found[worst.first].start),
                  sphinx_boundary(found[worst.first + worst.count - 1].end), worst.distance, mismatch));
}

}  // namespace

std::optional<PhoneTrack> Align::operator()(const Audio& audio, const Transcript* transcript, const WordTrack* track,
                                            const PhoneTrack* given) const {
  if (given) return *given;
  if (!transcript && !track) return {};
  const Words words = known_words(transcript, track);
  if (words.empty() && transcript)
    throw std::runtime_error("phones.align: the transcript holds no word; leave it out to have the phones recognised");
  if (words.empty()) return all_silence(audio);
  if (is_blank(audio))
    throw std::runtime_error(
        fmt::format("phones.align: there is no sound for {}: the recording, {:.2f} s, is silent; check that transcript "
                    "and sound belong together",
                    quote(words), audio.seconds()));

  if (audio.seconds() > kLongest)
    throw std::runtime_error(fmt::format(
        "phones.align: the sound lasts {:.0f} s, PocketSphinx takes at most {:.0f} s at once; cut it at a pause",
        audio.seconds(), kLongest));
  const auto aligner = decoder_pool<SphinxAligner>().take();
  learn_missing(*aligner, words);
  const auto result = aligner->align(sphinx_samples(audio), words);
  check_fit(result, words, mismatch);
  return phone_track(result.phones, audio.seconds());
}

void describe(Description<Align>& d) {
  d.type("phones.align").summary("times of the phones of known words, by forced alignment").stored();
  d.source("PocketSphinx 0.8+5prealpha with its en-us model");
  d.input("audio", "the speech").input("transcript", "what is said").input("words", "instead of a transcript");
  d.input("given", "phones from the corpus, passed on");
  d.output("phones", "nothing where neither words nor phones are known");
  d.param("mismatch", &Align::mismatch)
      .positive()
      .doc(
          "how unlike its words a second of speech may be before the transcript counts as wrong: about 20 for a right "
          "transcript, 50 to 80 for another one");
}

}  // namespace talkgraph
