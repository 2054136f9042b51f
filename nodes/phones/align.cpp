#include "nodes/phones/align.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

int length(std::span<const FrameSpan> spans) {
  int frames = 0;
  for (const auto& span : spans) frames += span.end - span.start;
  return frames;
}

/// The distance from the sound, summed over frames.
double unlikeness(std::span<const FrameSpan> spans) {
  double sum = 0;
  for (const auto& span : spans) sum -= span.score * (span.end - span.start);
  return sum;
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
    frames += length(spans.subspan(end, 1));
    sum += unlikeness(spans.subspan(end, 1));
  }
  if (frames == 0 || (first > 0 && frames < kFrames)) return {};
  return Stretch{spans.subspan(first, end - first), sum / frames};
}

/// The likeliest phones of a sound, found where they are asked for, together with what is around, to which the
/// model adapts.
class LikeliestPhones {
 public:
  explicit LikeliestPhones(std::span<const std::int16_t> sound) : sound_(sound) {}

  /// The phones between two frames, cut there.
  std::vector<FrameSpan> between(int start, int end) {
    if (start < start_ || end > end_) decode(start, end);
    std::vector<FrameSpan> inside;
    for (auto phone : phones_) {
      phone.start = std::max(start, phone.start);
      phone.end = std::min(end, phone.end);
      if (phone.start < phone.end) inside.push_back(std::move(phone));
    }
    return inside;
  }

  /// How unlike the sound of the words even they are, a frame.
  double distance(std::span<const FrameSpan> words) {
    if (words.front().start < start_ || words.back().end > end_) decode(words.front().start, words.back().end);
    int frames = 0;
    double sum = 0;
    for (const auto& word : words) {
      if (is_filler(word)) continue;
      const auto phones = between(word.start, word.end);
      frames += length(phones);
      sum += unlikeness(phones);
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
    for (auto& phone : phones_) phone.start += start_, phone.end += start_;
  }

  std::span<const std::int16_t> sound_;
  int start_ = 0, end_ = 0;
  std::vector<FrameSpan> phones_;
};

/// By how much a stretch may be further from its sound: of the many of a long recording some are by chance.
double limit_for(std::span<const FrameSpan> spans, double mismatch) {
  const double stretches = std::max(1.0, length(spans) / 500.0);
  return mismatch * (1 + 0.05 * std::log(stretches));
}

/// The first stretch that is by more than `limit` further from its sound than the likeliest
/// phones; nothing where the words fit.
std::optional<Stretch> unlike(std::span<const FrameSpan> spans, LikeliestPhones& likeliest, double limit) {
  constexpr double kNearest = 10;  // no phones are nearer to their sound
  int fits_until = 0;
  for (std::size_t first = 0; first < spans.size(); ++first) {
    if (is_filler(spans[first]) || spans[first].start < fits_until) continue;
    auto stretch = stretch_from(spans, first);
    if (!stretch) break;
    if (stretch->distance <= limit + kNearest) continue;
    stretch->distance -= likeliest.distance(stretch->spans);
    if (stretch->distance > limit) return stretch;
    fits_until = (stretch->spans.front().start + stretch->spans.back().end) / 2;
  }
  return {};
}

/// What is said where the words leave a pause: from the first to the last of its likeliest phones.
struct Unwritten {
  int start = 0, end = 0;
  double excess = 0;  ///< by how much a pause is less likely there, summed over frames
};

/// The pauses that are by more than `least`, summed over frames, further from their sound than its likeliest phones.
std::vector<Unwritten> unwritten(std::span<const FrameSpan> spans, LikeliestPhones& likeliest, double least) {
  constexpr int kShortest = 20;
  std::vector<Unwritten> found;
  for (std::size_t first = 0, end = 0; first < spans.size(); first = end + 1) {
    end = first;
    while (end < spans.size() && is_filler(spans[end])) ++end;
    const auto pause = spans.subspan(first, end - first);
    double excess = unlikeness(pause);
    if (excess <= least) continue;
    auto phones = likeliest.between(pause.front().start, pause.back().end);
    excess -= unlikeness(phones);
    std::erase_if(phones, is_filler);
    if (excess > least && length(phones) >= kShortest)
      found.push_back({phones.front().start, phones.back().end, excess});
  }
  return found;
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

/// Up to a second of what is not in the transcript (a cough, a slip of the tongue) is told, more is refused.
void check_pauses(std::span<const FrameSpan> spans, LikeliestPhones& likeliest, double mismatch, Context& context) {
  constexpr double kTold = 30, kRefused = 100;  // frames of words at the limit
  for (const auto& speech : unwritten(spans, likeliest, kTold * mismatch)) {
    const std::string message = fmt::format("what is said from {:.2f} s to {:.2f} s is not in the transcript",
                                            sphinx_boundary(speech.start), sphinx_boundary(speech.end));
    if (speech.excess > kRefused * mismatch)
      throw std::runtime_error("phones.align: " + message +
                               "; complete the transcript, or leave it out to have the phones recognised");
    context.warn(message + ": it counts as a pause");
  }
}

void check_fit(const SphinxAligner::Result& result, const Words& words, LikeliestPhones& likeliest, double mismatch) {
  const double limit = limit_for(result.words, mismatch);
  const auto stretch = unlike(result.words, likeliest, limit);
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
        "phones, at most {:.0f} is taken); correct the transcript, or leave it out to have the phones recognised",
        place(*stretch), stretch->distance, limit));
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
                                           const PhoneTrack* given, Context& context) const {
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
  LikeliestPhones likeliest(samples);
  check_fit(result, words, likeliest, mismatch);
  check_pauses(result.words, likeliest, mismatch, context);
  const auto starts = phone_starts(result.phones, sound);
  return Alignment{phone_track(result.phones, starts, audio.seconds()), word_track(result, starts, audio.seconds())};
}

void describe(Description<Align>& d) {
  d.type("phones.align").version(4).summary("times of the phones of known words, by forced alignment").stored();
  d.source("PocketSphinx 0.8+5prealpha with its en-us model");
  d.input("audio", "the speech").input("transcript", "what is said").input("words", "instead of a transcript");
  d.input("given", "phones from the corpus, passed on");
  d.output("phones", &Alignment::phones, "nothing where neither words nor phones are known");
  d.output("words", &Alignment::words, "the words as they are spoken");
  d.param("mismatch", &Align::mismatch)
      .positive()
      .doc(
          "by how much the words of five seconds may be less likely than the likeliest phones, as a log likelihood a "
          "frame, before the transcript counts as wrong (in long recordings a little more): up to 15 for natural "
          "speech with its transcript (33 for "
          "espeak-ng), 33 to 100 with another one; what is said in pauses counts as unwritten where it is by 0.3 s of "
          "this likelier than a pause, and is refused from 1 s of it");
}

}  // namespace talkgraph
