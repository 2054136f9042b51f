#include "nodes/speech/frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talkgraph {

Frames Frame::operator()(const Audio& audio) const {
  if (audio.rate <= 0) throw std::runtime_error("sound with a sample rate that is not positive");
  const auto length = static_cast<Eigen::Index>(std::lround(window * audio.rate));
  const double hop = audio.rate / rate.value();  // samples, not whole in general
  if (length < 1 || hop < 1)
    throw std::invalid_argument("window and hop must hold at least one sample at this sample rate");
  const auto begin = [&](Eigen::Index t) {
    return static_cast<Eigen::Index>(std::llround(static_cast<double>(t) * hop));
  };
  const auto samples = audio.samples.size();
  Eigen::Index count = 1;
  if (samples > length) count = static_cast<Eigen::Index>(static_cast<double>(samples - length) / hop) + 2;
  while (count > 1 && begin(count - 1) + length > samples) --count;

  Frames out;
  out.rate = rate;
  out.start = window / 2;
  out.sample_rate = audio.rate;
  out.values.setZero(count, length);
  for (Eigen::Index t = 0; t < count; ++t) {
    const auto n = std::min(length, samples - begin(t));
    out.values.row(t).head(n) = audio.samples.segment(begin(t), n).transpose();
  }
  return out;
}

void describe(Description<Frame>& d) {
  d.type("speech.frame").summary("cuts sound into overlapping frames").source("Thesis §3.2");
  d.input("audio").output("frames");
  d.param("window", &Frame::window).positive().unit("s").doc("length of a frame");
  d.param("rate", &Frame::rate).positive().unit("1/s").doc("frames per second");
}

}  // namespace talkgraph
