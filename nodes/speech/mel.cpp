#include "nodes/speech/mel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talkgraph {
namespace {

double to_mel(double hz) { return 1127 * std::log(1 + hz / 700); }

}  // namespace

Eigen::MatrixXd Mel::weights(Eigen::Index bins, double bin_hz) const {
  const double nyquist = bin_hz * static_cast<double>(bins - 1);
  const double top = high > 0 ? high : nyquist;
  if (low >= top || top > nyquist * (1 + 1e-9))
    throw std::invalid_argument("mel filters from " + std::to_string(low) + " to " + std::to_string(top) +
                                " Hz do not fit below the Nyquist frequency of " + std::to_string(nyquist) + " Hz");
  const double first = to_mel(low), step = (to_mel(top) - first) / (filters + 1);
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(bins, filters);
  for (Eigen::Index b = 0; b < bins; ++b) {
    const double at = (to_mel(static_cast<double>(b) * bin_hz) - first) / step;  // in filter spacings
    for (int m = 0; m < filters; ++m) w(b, m) = std::max(0.0, 1 - std::abs(at - (m + 1)));
  }
  return w;
}

Track Mel::operator()(const Spectrum& spectrum) const {
  const Eigen::MatrixXd w = weights(spectrum.values.cols(), spectrum.bin_hz());
  const double full = spectrum.power ? scale * scale : scale;
  Track out;
  out.rate = spectrum.rate;
  out.start = spectrum.start;
  out.values = (full * (spectrum.values * w)).cwiseMax(floor).array().log();
  return out;
}

void describe(Description<Mel>& d) {
  d.type("speech.mel")
      .summary("log mel filter bank, HTK convention")
      .source("Thesis §3.2; HTK Book, filter bank analysis");
  d.input("spectrum", "of the frames").output("track", "T x filters");
  d.param("filters", &Mel::filters).within(1, 1000).doc("number of triangular filters");
  d.param("low", &Mel::low).at_least(0).unit("Hz").doc("lower edge of the first filter");
  d.param("high", &Mel::high).at_least(0).unit("Hz").doc("upper edge of the last filter; 0: Nyquist");
  d.param("scale", &Mel::scale).positive().doc("full scale of the samples: 32768 as 16-bit tools have it");
  d.param("floor", &Mel::floor).positive().doc("least filter output, so that silence stays finite");
}

}  // namespace talkgraph
