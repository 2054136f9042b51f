#include "nodes/speech/mel.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {
namespace {

const double slaney_step = std::log(6.4) / 27;  // of ln f above 1 kHz

double to_mel(MelScale scale, double hz) {
  if (scale == MelScale::htk) return 1127 * std::log(1 + hz / 700);
  return hz < 1000 ? hz * 3 / 200 : 15 + std::log(hz / 1000) / slaney_step;
}

double to_hz(MelScale scale, double mel) {
  if (scale == MelScale::htk) return 700 * std::expm1(mel / 1127);
  return mel < 15 ? mel * 200 / 3 : 1000 * std::exp((mel - 15) * slaney_step);
}

double triangle(double left, double centre, double right, double at) {
  if (at < left || at >= right) return 0;
  return at < centre ? (at - left) / (centre - left) : (right - at) / (right - centre);
}

}  // namespace

Eigen::VectorXd Mel::edges(double nyquist) const {
  Eigen::VectorXd edges =
      Eigen::VectorXd::LinSpaced(filters + 2, to_mel(mel, low), to_mel(mel, bank_end(low, high, nyquist)));
  for (auto& edge : edges) edge = to_hz(mel, edge);
  return edges;
}

Eigen::MatrixXd Mel::weights(Eigen::Index bins, double bin_hz) const {
  const Eigen::VectorXd hz = edges(bin_hz * static_cast<double>(bins - 1));
  const double size = static_cast<double>(2 * (bins - 1));
  // Where a frequency lies on the axis that triangles are linear in.
  const auto place = [&](double f) { return triangles == Triangles::mel ? to_mel(mel, f) : f; };
  const auto edge = [&](Eigen::Index m) {
    return triangles == Triangles::bins ? bin_hz * std::floor((size + 1) * hz[m] / (size * bin_hz)) : place(hz[m]);
  };
  Eigen::MatrixXd w(bins, filters);
  for (Eigen::Index m = 0; m < filters; ++m) {
    const double left = edge(m), centre = edge(m + 1), right = edge(m + 2);
    const double peak = unit_area ? 2 / (hz[m + 2] - hz[m]) : 1;
    for (Eigen::Index b = 0; b < bins; ++b)
      w(b, m) = peak * triangle(left, centre, right, place(static_cast<double>(b) * bin_hz));
  }
  return w;
}

FilterOutputs Mel::operator()(const Spectrum& spectrum) const {
  const double nyquist = spectrum.sample_rate / 2;
  return {log_outputs(spectrum, weights(spectrum.values.cols(), spectrum.bin_hz()), scale, floor),
          {edges(nyquist).segment(1, filters), nyquist}};
}

void describe(Description<Mel>& d) {
  d.type("speech.mel").version(2).summary("log mel filter bank").source("Thesis §3.2; HTK Book, filter bank analysis");
  d.input("spectrum", "of the frames");
  d.output("track", &FilterOutputs::track, "T x filters")
      .output("bands", &FilterOutputs::bands, "centres of the filters");
  d.param("filters", &Mel::filters).within(1, 1000).doc("number of triangular filters");
  d.param("low", &Mel::low).at_least(0).unit("Hz").doc("lower edge of the first filter; Kaldi: 20");
  d.param("high", &Mel::high).at_least(0).unit("Hz").doc("upper edge of the last filter; 0: Nyquist");
  d.param("mel", &Mel::mel)
      .doc("htk: 1127 ln(1 + f / 700), also of Kaldi and python_speech_features; slaney: linear to 1 kHz (librosa)");
  d.param("triangles", &Mel::triangles)
      .doc(
          "linear in mel (HTK, Kaldi), in hertz (Slaney, librosa), or in bins, edges rounded down to one "
          "(python_speech_features)");
  d.param("unit_area", &Mel::unit_area).doc("triangles of area 1 over Hz (Slaney, librosa) instead of height 1");
  d.param("scale", &Mel::scale).positive().doc("full scale of the samples: 32768 as 16-bit tools have it");
  d.param("floor", &Mel::floor)
      .positive()
      .doc(
          "least filter output, so that silence stays finite; HTK: 1, Kaldi: 1.1920929e-7, "
          "python_speech_features: 2.220446049250313e-16");
}

}  // namespace talkgraph
