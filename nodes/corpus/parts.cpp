#include "nodes/corpus/parts.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace talkgraph {
namespace {

void check_landmarks(const LandmarkTrack& landmarks, const VideoSource& video) {
  if (std::abs(std::ssize(landmarks.frames) - video.frames()) > 2)
    throw std::runtime_error(
        fmt::format("{}: has {} frames, but its landmarks are of {}; if they are of some frames only, the manifest "
                    "says \"sparse\": true",
                    video.name(), video.frames(), landmarks.frames.size()));
  if (landmarks.rate != video.rate())
    throw std::runtime_error(fmt::format("{}: has {} frames per second, but its landmarks {}", video.name(),
                                         video.rate().str(), landmarks.rate.str()));
}

void check_rate(const std::string& name, const Rational& rate, const Rational& fps) {
  if (fps.num() == 0 || rate == fps) return;
  throw std::runtime_error(fmt::format(
      "{}: has {} frames per second, this graph works at {}: set its fps to {}, if all recordings have that rate", name,
      rate.str(), fps.str(), rate.str()));
}

void check_end(const std::string& id, const char* what, const std::vector<Interval>& labels, double seconds) {
  if (labels.empty()) return;
  const double end = labels.back().end;
  if (end > seconds + 0.5 || end < 0.1 * seconds)
    throw std::runtime_error(
        fmt::format("{}: its {} end at {:.6g} s, its sound at {:.2f} s: are the times in the unit of the format (HTK "
                    ".lab: 100 ns, GRID .align: 1/25000 s), and of this recording?",
                    id, what, end, seconds));
}

}  // namespace

RecordingParts Parts::operator()(const Recording& recording, Context& context) const {
  RecordingParts parts{
      recording.audio(), {}, recording.transcript, recording.words, recording.phones, recording.landmarks,
      recording.visual};
  const auto compare = [&](double seconds, const char* what) {
    if (std::abs(parts.audio.seconds() - seconds) > tolerance)
      context.warn(fmt::format("{}: the sound lasts {:.2f} s, the {} {:.2f} s: do they belong together?", recording.id,
                               parts.audio.seconds(), what, seconds));
  };
  if (parts.phones) check_end(recording.id, "phones", parts.phones->phones, parts.audio.seconds());
  if (parts.words) check_end(recording.id, "words", parts.words->words, parts.audio.seconds());
  if (parts.visual) {
    check_rate(recording.id + ": visual track", parts.visual->rate, fps);
    compare(static_cast<double>(parts.visual->frames()) / parts.visual->rate.value(), "visual track");
  }
  if (!recording.video) return parts;
  parts.video = recording.video();
  check_rate(parts.video->source->name(), parts.video->source->rate(), fps);
  if (!check) return parts;
  const VideoSource& source = *parts.video->source;
  if (parts.landmarks) check_landmarks(*parts.landmarks, source);
  compare(static_cast<double>(source.frames()) / source.rate().value(), "picture");
  return parts;
}

void describe(Description<Parts>& d) {
  d.type("corpus.parts").summary("takes a recording apart: sound, pictures, labels");
  d.input("recording", "one utterance");
  d.output("audio", &RecordingParts::audio, "its sound, one channel");
  d.output("video", &RecordingParts::video, "its pictures");
  d.output("transcript", &RecordingParts::transcript, "what is said");
  d.output("words", &RecordingParts::words, "words with their times");
  d.output("phones", &RecordingParts::phones, "phones with their times, where the corpus has them");
  d.output("landmarks", &RecordingParts::landmarks, "points of every frame, where the corpus has them");
  d.output("visual", &RecordingParts::visual, "ready-made visual track");
  d.param("fps", &Parts::fps).unit("frames/s").doc("rate that pictures and visual tracks must have; 0: any");
  d.param("check", &Parts::check)
      .doc("counts the frames, for which the video is decoded once; off where only sound is used");
  d.param("tolerance", &Parts::tolerance).positive().unit("s").doc("difference of sound and picture that is warned of");
}

}  // namespace talkgraph
