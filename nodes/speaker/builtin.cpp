#include "nodes/speaker/builtin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "graph/random.h"
#include "nodes/media/resample.h"
#include "nodes/speaker/articulation.h"
#include "nodes/speaker/face.h"
#include "nodes/speaker/head_motion.h"
#include "nodes/speaker/renderer.h"
#include "nodes/speaker/sentences.h"
#include "nodes/speaker/talking_video.h"
#include "nodes/voice/voice.h"

namespace talkgraph {
namespace {

constexpr double silence = 0.2;      ///< before and after the speech, seconds
constexpr double room_noise = 1e-4;  ///< standard deviation, full scale 1

/// How one sentence is said.
struct Delivery {
  Voice voice;
  double loudness;  ///< 1 is the loudest
  Effort effort;
};

Delivery choose_delivery(Random& random) {
  Delivery d;
  d.voice.rate = std::round(random.uniform(145, 185));
  d.voice.pitch = std::round(random.uniform(42, 60));
  d.loudness = random.uniform(0.5, 0.95);
  d.effort.opening = std::pow(d.loudness / 0.72, 0.6) * std::pow(165 / d.voice.rate, 0.7);
  return d;
}

/// Where the speech stands within the recording.
struct Timing {
  std::int64_t frames;
  double seconds;
};

Timing timing_of(const Utterance& u, Rational fps) {
  const auto frames = static_cast<std::int64_t>(std::ceil((u.audio.seconds() + 2 * silence) * fps.value() - 1e-9));
  return {frames, static_cast<double>(frames) / fps.value()};
}

/// Labels later by the silence in front, covering the whole recording.
std::vector<Interval> embed(std::vector<Interval> labels, double seconds) {
  for (auto& l : labels) l.start += silence, l.end += silence;
  const auto cover = [&](auto at, double start, double end) { labels.insert(at, Interval{"sil", start, end}); };
  if (labels.front().label == "sil")
    labels.front().start = 0;
  else
    cover(labels.begin(), 0, silence);
  if (labels.back().label == "sil")
    labels.back().end = seconds;
  else
    cover(labels.end(), labels.back().end, seconds);
  return labels;
}

Audio record_sound(const std::string& text, const Delivery& delivery, double seconds, double rate, std::uint64_t seed,
                   const std::string& id) {
  const auto spoken = speak(text, delivery.voice).audio;
  Audio all{Eigen::VectorXd::Zero(std::llround(seconds * spoken.rate)), spoken.rate};
  all.samples.segment(std::llround(silence * spoken.rate), spoken.samples.size()) = delivery.loudness * spoken.samples;
  if (rate != all.rate) {
    Resample resample;
    resample.rate = rate;
    all = resample(all);
  }
  Audio exact{Eigen::VectorXd::Zero(std::llround(seconds * rate)), rate};
  const auto common = std::min(exact.samples.size(), all.samples.size());
  exact.samples.head(common) = all.samples.head(common);
  Random random(seed, "speaker.builtin sound", id);
  for (double& s : exact.samples) s = std::clamp(s + room_noise * random.normal(), -1.0, 1.0);
  return exact;
}

std::vector<face::Moment> record_face(const PhoneTrack& phones, const Delivery& delivery, std::int64_t frames,
                                      Rational fps, Random& random) {
  const auto mouth = articulate(phones, fps, frames, delivery.effort);
  const auto head = head_motion(frames, fps, random);
  std::vector<face::Moment> moments;
  for (std::size_t n = 0; n < mouth.size(); ++n) moments.push_back({mouth[n], head[n]});
  return moments;
}

std::vector<face::Bound> points_of(SpeakerPoints scheme) {
  auto points = face::landmarks();
  if (scheme == SpeakerPoints::face56) points.erase(points.begin() + 36, points.begin() + 48);
  if (scheme == SpeakerPoints::ibug69) points.push_back(face::bind({face::centre_x, 88}, face::Part::brow));
  return points;
}

LandmarkTrack mark(const std::vector<face::Moment>& moments, Rational fps, int height, SpeakerPoints scheme) {
  LandmarkTrack track;
  track.rate = fps;
  for (const auto& entry : enum_names<SpeakerPoints>.entries)
    if (entry.value == scheme) track.scheme = entry.name;
  const auto points = points_of(scheme);
  for (const auto& m : moments) track.frames.push_back(face::picture_landmarks(points, m, height));
  return track;
}

/// Where the articulators and the head are, in the order of their names.
Track truth(const std::vector<face::Moment>& moments, Rational fps) {
  Track track;
  track.rate = fps;
  track.start = 0.5 / fps.value();
  track.names = {"jaw",        "width",      "protrusion", "upper_lip", "lower_lip", "closure", "bite",
                 "tongue_tip", "tongue_out", "dx",         "dy",        "roll",      "scale",   "yaw",
                 "pitch",      "blink",      "brow",       "gaze_x",    "gaze_y"};
  track.values.resize(std::ssize(moments), std::ssize(track.names));
  for (Eigen::Index n = 0; n < track.frames(); ++n) {
    const auto& [a, h] = moments[static_cast<std::size_t>(n)];
    track.values.row(n) << a.jaw, a.width, a.protrusion, a.upper_lip, a.lower_lip, a.closure, a.bite, a.tongue_tip,
        a.tongue_out, h.dx, h.dy, h.roll, h.scale, h.yaw, h.pitch, h.blink, h.brow, h.gaze_x, h.gaze_y;
  }
  return track;
}

std::vector<std::size_t> choose_sentences(std::uint64_t seed) {
  std::vector<std::size_t> order(speaker_sentence_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(seed, "speaker.builtin", "order");
  random.shuffle(order);
  return order;
}

Recording record(const BuiltinSpeaker& node, const std::shared_ptr<const face::Portrait>& portrait, std::string id,
                 std::string_view sentence) {
  const auto seed = static_cast<std::uint64_t>(node.seed);
  Random random(seed, "speaker.builtin", id);
  const auto delivery = choose_delivery(random);
  const std::string text(sentence);
  const auto said = speak(text, delivery.voice);
  const auto timing = timing_of(said, node.fps);

  Recording r;
  r.id = id;
  r.transcript = Transcript{text};
  r.phones = PhoneTrack{embed(said.phones.phones, timing.seconds)};
  r.words = WordTrack{embed(said.words.words, timing.seconds)};
  auto moments = record_face(*r.phones, delivery, timing.frames, node.fps, random);
  r.landmarks = mark(moments, node.fps, static_cast<int>(node.height), node.points);
  r.visual = truth(moments, node.fps);
  r.audio = [=, rate = node.sample_rate] { return record_sound(text, delivery, timing.seconds, rate, seed, id); };
  r.key = [key = KeyMaker()
                     .add(fmt::format("built-in speaker: seed {}, height {}, fps {}, sample rate {}", node.seed,
                                      node.height, node.fps.str(), node.sample_rate))
                     .add(id)
                     .add(text)
                     .key()] { return key; };
  const auto video =
      face::talking_video(portrait, std::move(moments), node.fps, "built-in speaker, " + id, r.key(), random.bits());
  r.video = [video] { return video; };
  return r;
}

}  // namespace

std::string complaint(const BuiltinSpeaker& node) {
  if (node.sentences > static_cast<std::int64_t>(speaker_sentence_count()))
    return fmt::format("the speaker knows {} sentences, not {}", speaker_sentence_count(), node.sentences);
  if (node.held_out + node.validation >= node.sentences)
    return fmt::format("{} held out and {} for validation leave none of {} sentences to train on", node.held_out,
                       node.validation, node.sentences);
  if (node.height % 2 != 0) return fmt::format("height must be even, got {}", node.height);
  return {};
}

Stream<Recording> BuiltinSpeaker::operator()() const {
  if (const auto why = complaint(*this); !why.empty()) throw std::invalid_argument("speaker.builtin: " + why);
  const auto portrait =
      std::make_shared<const face::Portrait>(static_cast<int>(height), static_cast<std::uint64_t>(seed));
  return Stream<Recording>(
      [node = *this, portrait, order = choose_sentences(static_cast<std::uint64_t>(seed)),
       i = std::int64_t{0}]() mutable -> std::optional<Item<Recording>> {
        if (i == node.sentences) return {};
        auto id = fmt::format("s{:03}", i + 1);
        auto recording = record(node, portrait, id, speaker_sentence(order[static_cast<std::size_t>(i)]));
        const auto left = node.sentences - i++;
        recording.split = left <= node.held_out                     ? "test"
                          : left <= node.held_out + node.validation ? "validation"
                                                                    : "train";
        return Item<Recording>{std::move(id), std::move(recording)};
      },
      static_cast<std::size_t>(sentences));
}

void describe(Description<BuiltinSpeaker>& d) {
  d.type("speaker.builtin")
      .version(2)
      .summary("a synthetic speaker: sound, pictures, phones, words, landmarks and what moved the face");
  d.output("recording", "one item a sentence");
  d.param("sentences", &BuiltinSpeaker::sentences)
      .within(1, static_cast<double>(speaker_sentence_count()))
      .doc("how many sentences are said");
  d.param("held_out", &BuiltinSpeaker::held_out).at_least(0).doc("the last so many are the test split");
  d.param("validation", &BuiltinSpeaker::validation).at_least(0).doc("so many before them are the validation split");
  d.param("fps", &BuiltinSpeaker::fps).within(5, 120).unit("frames per second").doc("rate of the pictures");
  d.param("height", &BuiltinSpeaker::height)
      .within(256, 1080)
      .unit("pixels")
      .doc("of the pictures, even; they are 5/4 as wide");
  d.param("sample_rate", &BuiltinSpeaker::sample_rate).within(8000, 96000).unit("Hz").doc("of the sound");
  d.param("seed", &BuiltinSpeaker::seed).at_least(0).doc("chooses sentences, delivery, head motion and complexion");
  d.param("points", &BuiltinSpeaker::points).doc("scheme of the landmarks");
}

}  // namespace talkgraph
