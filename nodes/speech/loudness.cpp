#include "nodes/speech/loudness.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace talkgraph {
namespace {

double weight(EqualLoudness curve, double hz, double nyquist) {
  if (curve == EqualLoudness::none) return 1;
  if (curve == EqualLoudness::htk) {
    const double f2 = hz * hz, share = f2 / (f2 + 1.6e5);
    return share * share * (f2 + 1.44e6) / (f2 + 9.61e6);
  }
  const double omega = 2 * std::numbers::pi * hz, w2 = omega * omega;
  const double e = (w2 + 56.8e6) * w2 * w2 / ((w2 + 6.3e6) * (w2 + 6.3e6) * (w2 + 0.38e9));
  return curve == EqualLoudness::hermansky_above_5khz && nyquist > 5000 ? e / (w2 * w2 * w2 + 9.58e26) : e;
}

}  // namespace

double log_equal_loudness(EqualLoudness curve, double hz, double nyquist) {
  return std::log(std::max(weight(curve, hz, nyquist), std::numeric_limits<double>::min()));
}

Track Loudness::operator()(const Track& track, const Bands& bands) const {
  if (bands.centres.size() != track.dimension())
    throw std::invalid_argument(std::to_string(track.dimension()) + " filter outputs but the centres of " +
                                std::to_string(bands.centres.size()) + " bands: take both from the same filter bank");
  Track out = track;
  for (Eigen::Index band = 0; band < track.dimension(); ++band)
    out.values.col(band).array() += log_equal_loudness(curve, bands.centres[band], bands.nyquist);
  out.values *= power;
  return out;
}

void describe(Description<Loudness>& d) {
  d.type("speech.loudness")
      .summary("equal loudness and the power law of hearing")
      .source("Thesis §3.2.5, Eqns 3.33 to 3.35; Hermansky 1990");
  d.input("track", "logs of filter outputs")
      .input("bands", "where the filters lie")
      .output("track", "logs of the loudness in each band");
  d.param("curve", &Loudness::curve)
      .doc(
          "hermansky: of the 1990 paper; hermansky_above_5khz: with its further factor where the Nyquist frequency is "
          "above 5 kHz; htk: as HTK and rastamat round it; none");
  d.param("power", &Loudness::power).positive().doc("loudness = intensity to this power; Kaldi: 1/3");
}

}  // namespace talkgraph
