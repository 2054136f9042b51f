#include "nodes/phones/align.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "nodes/media/audio_file.h"
#include "nodes/phones/boundaries.h"
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

std::string quote(std::span<const std::string> words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return '"' + text + '"';
}

/// A run that holds five seconds of words, or all where those are fewer, and how unlike the sound its
/// words are, as a distance per frame.
struct Stretch {
  std::span<const FrameSpan> spans;
  double distance = 0;
};

std::optional<Stretch> stretch_from(std::span<const FrameSpan> spans, std::size_t first) {
  constexpr int kFrames = 500;
  int frames = 0;
  double sum = 0;
  std::size_t end = first;
  for (; end < spans.size() && frames < kFrames; ++end) {
    if (is_filler(spans[end])) continue;
    const int length = spans[end].end - spans[end].start;
    frames += length;
    sum -= spans[end].score * length;
  }
  if (frames == 0 || (first > 0 && frames < kFrames)) return {};
  return Stretch{spans.subspan(first, end - first), sum / frames};
}

/// The likeliest phones of stretches of a sound, found together with what is around, to which the model adapts.
class LikeliestPhones {
 public:
  explicit LikeliestPhones(std::span<const std::int16_t> sound) : sound_(sound) {}

  /// How unlike the sound of the words even they are.
  double distance(std::span<const FrameSpan> words) {
    if (words.front().start < start_ || words.back().end > end_) decode(words.front().start, words.back().end);
    int frames = 0;
    double sum = 0;
    for (const auto& word : words)
      for (const auto& phone : phones_) {
        const int common = std::min(word.end, start_ + phone.end) - std::max(word.start, start_ + phone.start);
        if (common <= 0 || is_filler(word)) continue;
        frames += common;
        sum -= phone.score * common;
      }
    return sum / std::max(1, frames);
  }

 private:
  void decode(int start, int end) {
    constexpr int kAround = 1000;
    start_ = std::max(0, start - kAround);
    end_ = end + kAround;
    const auto first = static_cast<std::size_t>(start_) * kSphinxHop;
    const auto last = std::min(static_cast<std::size_t>(end_) * kSphinxHop, sound_.size());
    phones_ = decoder_pool<SphinxPhoneLoop>().take()->decode(sound_.subspan(first, last - first));
  }

  std::span<const std::int16_t> sound_;
  int start_ = 0, end_ = 0;
  std::vector<FrameSpan> phones_;
};

/// The first stretch that is by more than `mismatch` further from its sound than the likeliest
/// phones; nothing where the words fit.
std::optional<Stretch> unlike(std::span<const FrameSpan> spans, std::span<const std::int16_t> sound, double mismatch) {
  constexpr double kNearest = 10;  // no phones are nearer to their sound
  LikeliestPhones likeliest(sound);
  int fits_until = 0;
  for (std::size_t first = 0; first < spans.size(); ++first) {
    if (is_filler(spans[first]) || spans[first].start < fits_until) continue;
    auto stretch = stretch_from(spans, first);
    if (!stretch) break;
    if (stretch->distance <= mismatch + kNearest) continue;
    stretch->distance -= likeliest.distance(stretch->spans);
    if (stretch->distance > mismatch) return stretch;
    fits_until = (stretch->spans.front().start + stretch->spans.back().end) / 2;
  }
  return {};
}

Words spoken(std::span<const FrameSpan> spans) {
  Words words;
  for (const auto& span : spans)
    if (!is_filler(span)) words.push_back(span.label.substr(0, span.label.find('(')));
  return words;
}

std::string place(const Stretch& stretch) {
  return fmt::format("{} from {:.2f} s to {:.2f} s is unlike what is said there", quote(spoken(stretch.spans)),
                     sphinx_boundary(stretch.spans.front().start), sphinx_boundary(stretch.spans.back().end));
}

void check_fit(const SphinxAligner::Result& result, const Words& words, std::span<const std::int16_t> sound,
               double mismatch) {
  const auto stretch = unlike(result.words, sound, mismatch);
  if (result.phones.empty()) {
    const std::size_t reached = std::min(spoken(result.words).size(), words.size() - 1);
    throw std::runtime_error(fmt::format(
        "phones.align: the {} words of the transcript do not fit into the sound: it ends in word {}, {}{}; check that "
        "transcript and sound belong together",
        words.size(), reached + 1, quote(std::span(words).subspan(reached, 1)),
        stretch ? ", and " + place(*stretch) : ""));
  }
  if (stretch)
    throw std::runtime_error(fmt::format(
        "phones.align: the transcript does not match the sound: {} (by {:.0f} a frame less likely than other "
        "phones, at most {:g} is taken); correct the transcript, or leave it out to have the phones recognised",
        place(*stretch), stretch->distance, mismatch));
}

/// The words between the phones that they begin with.
WordTrack word_track(const SphinxAligner::Result& result, const std::vector<double>& starts, double seconds) {
  WordTrack track;
  std::size_t phone = 0;
  for (const auto& word : result.words) {
    const double start = starts[phone];
    while (phone < starts.size() && result.phones[phone].start < word.end) ++phone;
    const double end = phone < starts.size() ? starts[phone] : seconds;
    if (end <= start) continue;
    const bool pause = is_filler(word);
    if (pause && !track.words.empty() && track.words.back().label == "sil")
      track.words.back().end = end;
    else
      track.words.push_back({pause ? "sil" : spoken({&word, 1}).front(), start, end});
  }
  return track;
}

}  // namespace

std::optional<Alignment> Align::operator()(const Audio& audio, const Transcript* transcript, const WordTrack* track,
                                           const PhoneTrack* given) const {
  if (given) return Alignment{*given, track ? *track : WordTrack{}};
  if (!transcript && !track) return {};
  const Words words = known_words(transcript, track);
  if (words.empty() && transcript)
    throw std::runtime_error("phones.align: the transcript holds no word; leave it out to have the phones recognised");
  if (words.empty()) return Alignment{all_silence(audio), {all_silence(audio).phones}};
  if (is_blank(audio))
    throw std::runtime_error(
        fmt::format("phones.align: there is no sound for {}: the recording, {:.2f} s, is silent; check that transcript "
                    "and sound belong together",
                    quote(words), audio.seconds()));

  const Audio sound = resampled(audio, kSphinxRate);
  const auto aligner = decoder_pool<SphinxAligner>().take();
  learn_missing(*aligner, words);
  const auto samples = sphinx_samples(sound);
  const auto result = aligner->align(samples, words);
  check_fit(result, words, samples, mismatch);
  const auto starts = phone_starts(result.phones, sound);
  return Alignment{phone_track(result.phones, starts, audio.seconds()), word_track(result, starts, audio.seconds())};
}

void describe(Description<Align>& d) {
  d.type("phones.align").version(3).summary("times of the phones of known words, by forced alignment").stored();
  d.source("PocketSphinx 0.8+5prealpha with its en-us model");
  d.input("audio", "the speech").input("transcript", "what is said").input("words", "instead of a transcript");
  d.input("given", "phones from the corpus, passed on");
  d.output("phones", &Alignment::phones, "nothing where neither words nor phones are known");
  d.output("words", &Alignment::words, "the words as they are spoken");
  d.param("mismatch", &Align::mismatch)
      .positive()
      .doc(
          "by how much the words of five seconds may be less likely than the likeliest phones, as a log likelihood a "
          "frame, before the transcript counts as wrong: up to 15 for natural speech with its transcript (33 for "
          "espeak-ng), 33 to 100 with another one");
}

}  // namespace talkgraph
