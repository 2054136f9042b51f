#include "nodes/speech/frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talkgraph {
namespace {

/// Where sample `at` lies in n samples that go on mirrored at both ends, the end samples twice.
Eigen::Index mirrored(Eigen::Index at, Eigen::Index n) {
  const auto turn = ((at % (2 * n)) + 2 * n) % (2 * n);
  return turn < n ? turn : 2 * n - 1 - turn;
}

}  // namespace

Frames Frame::operator()(const Audio& audio) const {
  if (!(audio.rate > 0)) throw std::runtime_error("sound with a sample rate that is not positive");
  if (!(audio.samples.array().abs() <= 1e100).all())  // their squares add up to a number
    throw std::runtime_error(
        "sound with NaN or infinite samples, or some above 1e100: look at the file that it was read from");
  const auto samples = audio.samples.size();
  const auto length = static_cast<Eigen::Index>(std::lround(window * audio.rate));
  const double hop = audio.rate / rate.value();  // samples, not whole in general
  if (length < 1 || hop < 1)
    throw std::invalid_argument("window and hop must hold at least one sample at " + std::to_string(audio.rate) +
                                " samples per second");

  // In units of 1 / num samples everything is whole, so only the quotient is rounded.
  const auto num = static_cast<double>(rate.num()), step = audio.rate * static_cast<double>(rate.den());
  const double lead = centred ? (static_cast<double>(length) * num - step) / 2 : 0;
  const auto begin = [&](Eigen::Index t) {
    return static_cast<Eigen::Index>(std::floor((static_cast<double>(t) * step - lead) / num + 0.5));
  };
  // Frames whose interval the sound begins; then the whole ones alone, or one more that covers the rest.
  auto count = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(audio.seconds() * rate.value() - 1e-6)));
  if (!centred) {
    ++count;
    while (count > 1 && begin(count - 1) + length > samples) --count;
    if (ends != FrameEnds::whole && begin(count - 1) + length < samples) ++count;
  }

  Frames out;
  out.rate = rate;
  out.start = centred ? 0.5 / rate.value() : window / 2;
  out.sample_rate = audio.rate;
  out.values.resize(count, length);
  for (Eigen::Index t = 0; t < count; ++t) {
    const auto start = begin(t), from = std::max<Eigen::Index>(0, start), to = std::min(samples, start + length);
    if (to - from < length) {
      out.values.row(t).setZero();
      if (ends == FrameEnds::mirror && samples > 0)
        for (Eigen::Index i = 0; i < length; ++i) out.values(t, i) = audio.samples[mirrored(start + i, samples)];
    }
    if (from < to) out.values.row(t).segment(from - start, to - from) = audio.samples.segment(from, to - from);
  }
  return out;
}

void describe(Description<Frame>& d) {
  d.type("speech.frame").version(2).summary("cuts sound into overlapping frames").source("Thesis §3.2, §3.5.1");
  d.input("audio", "at any rate").output("frames", "T x samples");
  d.param("window", &Frame::window).positive().unit("s").doc("length of a frame");
  d.param("rate", &Frame::rate).positive().unit("1/s").doc("frames per second");
  d.param("centred", &Frame::centred)
      .doc("frame t lies around (t + ½) / rate, as video frames do: features straight at the video rate");
  d.param("ends", &Frame::ends)
      .doc(
          "whole: only whole frames (HTK, Kaldi), but zeros where centred frames reach out; zeros: the last frame is "
          "filled up "
          "(python_speech_features); mirror: with the sound mirrored (Kaldi's --snip-edges=false, with centred)");
}

}  // namespace talkgraph
