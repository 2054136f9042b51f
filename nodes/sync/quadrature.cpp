#include "nodes/sync/quadrature.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nodes/sync/filter.h"

namespace talkgraph {
namespace {

/// The bank's lowest band. Times are in input frames from the centre of a video frame.
class LowestBand {
 public:
  LowestBand(int bands, int length, double beta) : middle_(std::numbers::pi / (2 * bands)), beta_(beta) {
    extent_ = length * bands;
    // The response at the band's middle grows with the cut-off.
    double low = 0, high = 2 * middle_;
    for (int i = 0; i < 60; ++i) {
      cutoff_ = (low + high) / 2;
      (response(middle_) < response(0) / std::numbers::sqrt2 ? low : high) = cutoff_;
    }
  }

  double extent() const { return extent_; }
  double prototype(double t) const { return sinc(cutoff_ * t / std::numbers::pi) * kaiser(t / extent_, beta_); }
  double analysis(double t) const { return prototype(t) * std::cos(middle_ * t + std::numbers::pi / 4); }

 private:
  double response(double frequency) const {
    double sum = prototype(0);
    for (int t = 1; t <= extent_; ++t) sum += 2 * prototype(t) * std::cos(frequency * t);
    return sum;
  }

  double middle_;  ///< radians per input frame
  double beta_, extent_ = 0, cutoff_ = 0;
};

}  // namespace

Track Quadrature::operator()(const Track& track, const Audio* audio) const {
  const Rational ratio = track.rate / rate;
  if (ratio.den() != 1 || ratio.num() < 2)
    throw std::runtime_error(
        fmt::format("a quadrature filter bank brings rates down by an integer, not {} frames per second to {}: use "
                    "sync.polyphase",
                    track.rate.str(), rate.str()));
  const auto bands = static_cast<int>(ratio.num());
  const LowestBand band(bands, length, beta);
  // What lies `length` video frames from the centre is analysed there, over `length` frames more.
  const auto reach = 2 * static_cast<Eigen::Index>(band.extent()) + 1;
  return filter_to_video(track, audio, rate, reach, [&](double phase) -> Eigen::RowVectorXd {
    Eigen::RowVectorXd weights = Eigen::RowVectorXd::Zero(2 * reach);
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const double at = static_cast<double>(i - reach + 1) - phase;
      for (int n = -length; n <= length; ++n) weights[i] += band.analysis(n * bands) * band.analysis(n * bands - at);
    }
    return weights / weights.sum();
  });
}

void describe(Description<Quadrature>& d) {
  d.type("sync.quadrature")
      .summary("to the video rate by the lowest band of a quadrature filter bank")
      .source("Thesis §3.5.1; Rothweiler 1983; Cruz-Roldán et al. 2002");
  d.input("track", "at an integer multiple of the video rate")
      .input("audio", "gives the exact length")
      .output("track", "at the video rate");
  d.param("rate", &Quadrature::rate).positive().unit("frames/s").doc("video rate");
  d.param("length", &Quadrature::length)
      .within(1, 100)
      .unit("video frames")
      .doc("of the prototype filter on each side of its middle");
  d.param("beta", &Quadrature::beta).within(0, 30).doc("of its Kaiser window: more suppresses aliases more");
}

}  // namespace talkgraph
