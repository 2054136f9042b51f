#include "nodes/speech/window.h"

#include <cmath>
#include <numbers>

namespace talkgraph {

Frames Window::operator()(const Frames& frames) const {
  const auto n = frames.values.cols();
  if (shape == WindowShape::rectangular || n < 2) return frames;
  const double a = shape == WindowShape::hamming ? 0.54 : 0.5;
  Eigen::RowVectorXd weights(n);
  for (Eigen::Index i = 0; i < n; ++i)
    weights[i] = a - (1 - a) * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n - 1));
  return {frames.values * weights.asDiagonal(), frames.rate, frames.start, frames.sample_rate};
}

void describe(Description<Window>& d) {
  d.type("speech.window").summary("weighs each frame with a window").source("Thesis §3.2");
  d.input("frames", "T x samples").output("frames", "the same, weighed");
  d.param("shape", &Window::shape).doc("symmetric window");
}

}  // namespace talkgraph
