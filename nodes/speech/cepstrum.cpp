#include "nodes/speech/cepstrum.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace talkgraph {

double lifter_weight(int n, double length) {
  return length > 0 ? 1 + length / 2 * std::sin(std::numbers::pi * n / length) : 1;
}

Track Cepstrum::operator()(const Track& track) const {
  const auto filters = track.dimension();
  if (coefficients > filters)
    throw std::invalid_argument("a cepstrum of " + std::to_string(coefficients) +
                                " coefficients needs as many filters, got " + std::to_string(filters));
  const int first = keep_zeroth ? 0 : 1;
  Eigen::MatrixXd dct(filters, coefficients - first);
  const double m = static_cast<double>(filters);
  for (int i = first; i < coefficients; ++i) {
    const double weight = lifter_weight(i, lifter) * std::sqrt((i == 0 && orthonormal ? 1 : 2) / m);
    for (Eigen::Index j = 0; j < filters; ++j)
      dct(j, i - first) = weight * std::cos(std::numbers::pi * i * (static_cast<double>(j) + 0.5) / m);
  }
  Track out;
  out.rate = track.rate;
  out.start = track.start;
  out.values = track.values * dct;
  for (int i = first; i < coefficients; ++i) out.names.push_back("c" + std::to_string(i));
  return out;
}

void describe(Description<Cepstrum>& d) {
  d.type("speech.cepstrum").summary("DCT of log filter outputs: mel cepstrum").source("Thesis §3.2; HTK Book");
  d.input("track", "log filter outputs").output("track", "T x coefficients");
  d.param("coefficients", &Cepstrum::coefficients).within(2, 1000).doc("with the 0th");
  d.param("keep_zeroth", &Cepstrum::keep_zeroth).doc("keep the 0th coefficient");
  d.param("orthonormal", &Cepstrum::orthonormal)
      .doc("the 0th by √(1/M), as Kaldi and python_speech_features have it, not by HTK's √(2/M)");
  d.param("lifter", &Cepstrum::lifter)
      .at_least(0)
      .doc("HTK's liftering parameter, 22 by default there, in Kaldi and in python_speech_features; 0: none");
}

}  // namespace talkgraph
