#include "nodes/speech/window.h"

#include <cmath>
#include <numbers>

namespace talkgraph {
namespace {

double weight(WindowShape shape, double theta) {
  switch (shape) {
    case WindowShape::hamming:
      return 0.54 - 0.46 * std::cos(theta);
    case WindowShape::hann:
      return 0.5 - 0.5 * std::cos(theta);
    case WindowShape::blackman:
      return 0.42 - 0.5 * std::cos(theta) + 0.08 * std::cos(2 * theta);
    case WindowShape::povey:
      return std::pow(0.5 - 0.5 * std::cos(theta), 0.85);
    case WindowShape::rectangular:
      break;
  }
  return 1;
}

template <class D>
void describe_window(D& d) {
  d.param("shape", &Window::shape)
      .doc("HTK: hamming; Kaldi: povey; rastamat: hann, open; python_speech_features: rectangular");
  d.param("span", &Window::span)
      .doc("symmetric: from end to end; periodic: without the last sample; open: without the zeros at both ends");
}

}  // namespace

Eigen::RowVectorXd Window::weights(Eigen::Index samples) const {
  Eigen::RowVectorXd weights = Eigen::RowVectorXd::Ones(samples);
  if (samples < 2) return weights;
  const double first = span == WindowSpan::open ? 1 : 0;
  const double round = static_cast<double>(samples) + (span == WindowSpan::symmetric ? -1 : first);
  for (Eigen::Index n = 0; n < samples; ++n)
    weights[n] = weight(shape, 2 * std::numbers::pi * (static_cast<double>(n) + first) / round);
  return weights;
}

Frames Window::operator()(const Frames& frames) const {
  return {frames.values * weights(frames.values.cols()).asDiagonal(), frames.rate, frames.start, frames.sample_rate};
}

void describe(Description<Window>& d) {
  d.type("speech.window").summary("weighs each frame with a window").source("Thesis §3.2");
  d.input("frames", "T x samples").output("frames", "the same, weighed");
  describe_window(d);
}

void parameters(Parameters<Window>& p) { describe_window(p); }

}  // namespace talkgraph
