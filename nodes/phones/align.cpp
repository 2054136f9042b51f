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

/// The share of phones that are squeezed into the model's shortest, one frame a state: where words do not belong they
/// are, or they cover what they have in common with the sound.
double squeezed(std::span<const FrameSpan> phones) {
  const auto is_short = [](const auto& phone) {
    constexpr int kShortest = 3;
    return !is_filler(phone) && phone.end - phone.start <= kShortest;
  };
  const auto spoken = phones.size() - static_cast<std::size_t>(std::count_if(phones.begin(), phones.end(), is_filler));
  return static_cast<double>(std::count_if(phones.begin(), phones.end(), is_short)) /
         static_cast<double>(std::max<std::size_t>(1, spoken));
}

/// A run that holds five seconds of words, or all where those are fewer, and how unlike the sound its words are.
struct Stretch {
  std::span<const FrameSpan> spans;
  double distance = 0;  ///< a frame, and for squeezed phones
};

std::optional<Stretch> stretch_from(const SphinxAligner::Result& result, std::size_t first) {
  constexpr int kFrames = 500;
  constexpr double kSqueezed = 60;
  const std::span spans(result.words);
  int frames = 0;
  double sum = 0;
  std::size_t end = first;
  for (; end < spans.size() && frames < kFrames; ++end) {
    if (is_filler(spans[end])) continue;
    frames += length(spans.subspan(end, 1));
    sum += unlikeness(spans.subspan(end, 1));
  }
  const bool all_words = std::all_of(spans.begin(), spans.begin() + static_cast<std::ptrdiff_t>(first), is_filler);
  if (frames == 0 || (frames < kFrames && !all_words)) return {};
  const auto starts_before = [](const FrameSpan& phone, int frame) { return phone.start < frame; };
  const auto from = std::lower_bound(result.phones.begin(), result.phones.end(), spans[first].start, starts_before);
  const auto to = std::lower_bound(from, result.phones.end(), spans[end - 1].end, starts_before);
  return Stretch{spans.subspan(first, end - first), sum / frames + kSqueezed * squeezed({from, to})};
}

/// How unlike a stretch may be: of the many of a long recording some are by chance.
double limit_for(std::span<const FrameSpan> spans, double mismatch) {
  const double stretches = std::max(1.0, length(spans) / 500.0);
  return mismatch * (1 + 0.05 * std::log(stretches));
}

/// The first stretch beyond the limit; nothing where the words fit.
std::optional<Stretch> unlike(const SphinxAligner::Result& result, double limit) {
  for (std::size_t first = 0; first < result.words.size(); ++first) {
    if (is_filler(result.words[first])) continue;
    const auto stretch = stretch_from(result, first);
    if (!stretch) break;
    if (stretch->distance > limit) return stretch;
  }
  return {};
}

/// The likeliest phones of a sound between two frames, cut there. What is around is decoded with them: the model
/// adapts to it.
std::vector<FrameSpan> likeliest_phones(std::span<const std::int16_t> sound, int start, int end) {
  constexpr int kAround = 1000;
  const int shift = std::max(0, start - kAround);
  const auto first = static_cast<std::size_t>(shift) * kSphinxHop;
  const auto last = std::min(static_cast<std::size_t>(end + kAround) * kSphinxHop, sound.size());
  std::vector<FrameSpan> inside;
  for (auto phone : decoder_pool<SphinxPhoneLoop>().take()->decode(sound.subspan(first, last - first))) {
    phone.start = std::max(start, phone.start + shift);
    phone.end = std::min(end, phone.end + shift);
    if (phone.start < phone.end) inside.push_back(std::move(phone));
  }
  return inside;
}

/// What is said where the words leave a pause: from the first to the last of its likeliest phones.
struct Unwritten {
  int start = 0, end = 0;
  int frames = 0;  ///< of phones
};

/// The pauses in which at least 0.2 s of phones are clearly likelier than a pause.
std::vector<Unwritten> unwritten(std::span<const FrameSpan> spans, std::span<const std::int16_t> sound) {
  constexpr int kShortest = 20;
  constexpr double kClearly = 1000;  // log likelihood; right transcripts stay below 330
  std::vector<Unwritten> found;
  for (std::size_t first = 0, end = 0; first < spans.size(); first = end + 1) {
    end = first;
    while (end < spans.size() && is_filler(spans[end])) ++end;
    const auto pause = spans.subspan(first, end - first);
    if (unlikeness(pause) <= kClearly) continue;
    auto phones = likeliest_phones(sound, pause.front().start, pause.back().end);
    if (unlikeness(pause) - unlikeness(phones) <= kClearly) continue;
    std::erase_if(phones, is_filler);
    if (length(phones) >= kShortest) found.push_back({phones.front().start, phones.back().end, length(phones)});
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

/// A little of what is not in the transcript (a cough, a slip of the tongue) is told, more is refused.
void check_pauses(std::span<const FrameSpan> spans, std::span<const std::int16_t> sound, double most,
                  Context& context) {
  for (const auto& speech : unwritten(spans, sound)) {
    const std::string message = fmt::format("what is said from {:.2f} s to {:.2f} s is not in the transcript",
                                            sphinx_boundary(speech.start), sphinx_boundary(speech.end));
    if (0.010 * speech.frames > most)
      throw std::runtime_error("phones.align: " + message +
                               "; complete the transcript, or leave it out to have the phones recognised");
    context.warn(message + ": it counts as a pause");
  }
}

void check_fit(const SphinxAligner::Result& result, const Words& words, double mismatch) {
  const double limit = limit_for(result.words, mismatch);
  const auto stretch = unlike(result, limit);
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
        "phones.align: the transcript does not match the sound: {} (its distance from the sound is {:.0f}, at most "
        "{:.0f} is taken); correct the transcript, or leave it out to have the phones recognised",
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
  check_fit(result, words, mismatch);
  check_pauses(result.words, samples, unwritten, context);
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
          "how far five seconds of words may be from the sound (in long recordings a little more) before the "
          "transcript "
          "counts as wrong: minus the log likelihood a frame, and 60 times the share of phones squeezed to 30 ms. Up "
          "to "
          "44 for natural speech with its transcript (52 for espeak-ng), 40 to 130 with another one");
  d.param("unwritten", &Align::unwritten)
      .at_least(0)
      .unit("s")
      .doc("speech that the transcript lacks, in one pause: more is refused, less is told and counts as a pause");
}

}  // namespace talkgraph
