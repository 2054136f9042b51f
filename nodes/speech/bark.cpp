#include "nodes/speech/bark.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {
namespace {

double to_bark(double hz) { return 6 * std::asinh(hz / 600); }
double to_hz(double bark) { return 600 * std::sinh(bark / 6); }

}  // namespace

Eigen::VectorXd Bark::centres(double nyquist) const {
  Eigen::VectorXd centres = Eigen::VectorXd::LinSpaced(filters, to_bark(low), to_bark(bank_end(low, high, nyquist)));
  for (auto& centre : centres) centre = to_hz(centre);
  return centres;
}

Eigen::MatrixXd Bark::weights(Eigen::Index bins, double bin_hz) const {
  const Eigen::VectorXd hz = centres(bin_hz * static_cast<double>(bins - 1));
  Eigen::MatrixXd w(bins, filters);
  for (Eigen::Index m = 0; m < filters; ++m)
    for (Eigen::Index b = 0; b < bins; ++b) {
      const double off = to_bark(static_cast<double>(b) * bin_hz) - to_bark(hz[m]);
      const bool beyond = truncated && (off < -2.5 || off > 1.3);
      w(b, m) = beyond ? 0 : std::pow(10, std::min({0.0, off + 0.5, -2.5 * (off - 0.5)}) / width);
    }
  return w;
}

FilterOutputs Bark::operator()(const Spectrum& spectrum) const {
  const double nyquist = spectrum.sample_rate / 2;
  return {log_outputs(spectrum, weights(spectrum.values.cols(), spectrum.bin_hz()), scale, floor),
          {centres(nyquist), nyquist}};
}

void describe(Description<Bark>& d) {
  d.type("speech.bark")
      .summary("log filter bank of critical bands")
      .source("Thesis §3.2.5, Figure 3.4; Hermansky 1990; rastamat");
  d.input("spectrum", "power spectrum of the frames");
  d.output("track", &FilterOutputs::track, "T x filters")
      .output("bands", &FilterOutputs::bands, "centres of the filters");
  d.param("filters", &Bark::filters).within(2, 1000).doc("number of critical-band filters");
  d.param("low", &Bark::low).at_least(0).unit("Hz").doc("centre of the first filter");
  d.param("high", &Bark::high).at_least(0).unit("Hz").doc("centre of the last filter; 0: Nyquist");
  d.param("width", &Bark::width).positive().doc("skirts this many times as wide");
  d.param("truncated", &Bark::truncated).doc("nothing from beyond 2.5 Bark below and 1.3 above a centre, as in 1990");
  d.param("scale", &Bark::scale).positive().doc("full scale of the samples: 32768 as 16-bit tools have it");
  d.param("floor", &Bark::floor).positive().doc("least filter output, so that silence stays finite");
}

}  // namespace talkgraph
