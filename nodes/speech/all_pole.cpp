#include "nodes/speech/all_pole.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nodes/speech/cepstrum.h"
#include "nodes/speech/lp_cepstrum.h"
#include "nodes/types/frames.h"

namespace talkgraph {
namespace {

/// Which band stands at a point of the spectrum.
Eigen::Index band_at(EdgeBands edges, Eigen::Index point, Eigen::Index bands) {
  switch (edges) {
    case EdgeBands::copied:
      return std::clamp<Eigen::Index>(point, 1, bands - 2);
    case EdgeBands::added:
      return std::clamp<Eigen::Index>(point - 1, 0, bands - 1);
    case EdgeBands::kept:
      break;
  }
  return point;
}

/// From the bands of a spectrum to its autocorrelations (bands × order + 1).
Eigen::MatrixXd inverse_dft(EdgeBands edges, Eigen::Index bands, int order) {
  const auto last = edges == EdgeBands::added ? bands + 1 : bands - 1;  // of the points
  if (order > last)
    throw std::invalid_argument("an all-pole model of order " + std::to_string(order) +
                                " needs a spectrum of more points, got " + std::to_string(last + 1));
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(bands, order + 1);
  for (Eigen::Index point = 0; point <= last; ++point) {
    const double share = (point == 0 || point == last ? 0.5 : 1) / static_cast<double>(last);
    for (int lag = 0; lag <= order; ++lag)
      matrix(band_at(edges, point, bands), lag) +=
          share * std::cos(std::numbers::pi * lag * static_cast<double>(point) / static_cast<double>(last));
  }
  return matrix;
}

}  // namespace

Track AllPole::operator()(const Track& track) const {
  const auto frames = track.frames(), block = std::min<Eigen::Index>(64, frames);
  if (track.dimension() < 3) throw std::invalid_argument("an all-pole model needs a spectrum of at least three bands");
  const Eigen::MatrixXd to_autocorrelation = inverse_dft(edges, track.dimension(), order);
  Eigen::ArrayXd lift(coefficients);
  for (int n = 0; n < coefficients; ++n)
    lift[n] = lifter_weight(n, lifter) * (n > 0 ? std::pow(n, lifter_exponent) : 1);

  const int first = keep_zeroth ? 0 : 1;
  Track out;
  out.rate = track.rate;
  out.start = track.start;
  for (int n = first; n < coefficients; ++n) out.names.push_back("c" + std::to_string(n));
  out.values.resize(frames, coefficients - first);
  LinearPrediction predictor;
  Eigen::VectorXd cepstrum(coefficients);
  FrameMatrix autocorrelation(block, order + 1);
  for (Eigen::Index begin = 0; begin < frames; begin += block) {
    const auto rows = std::min(block, frames - begin);
    autocorrelation.topRows(rows) = track.values.middleRows(begin, rows).array().exp().matrix() * to_autocorrelation;
    for (Eigen::Index t = 0; t < rows; ++t) {
      levinson(autocorrelation.row(t).transpose(), predictor);
      lp_cepstrum(predictor, cepstrum);
      out.values.row(begin + t) = (lift * cepstrum.array()).tail(coefficients - first);
    }
  }
  return out;
}

void describe(Description<AllPole>& d) {
  d.type("speech.all_pole")
      .summary("cepstrum of an all-pole model of the auditory spectrum: PLP")
      .source("Thesis §3.2.5; Hermansky 1990; HTK Book; rastamat");
  d.input("track", "logs of the loudness in each band").output("track", "T x coefficients");
  d.param("edges", &AllPole::edges)
      .doc(
          "what stands at 0 Hz and at the Nyquist frequency: copied over the first and last band from their neighbours "
          "(rastamat), added beside them (HTK, Kaldi), or the bands kept as they are");
  d.param("order", &AllPole::order).within(1, 1000).doc("of the all-pole model");
  d.param("coefficients", &AllPole::coefficients).within(2, 1000).doc("with the 0th");
  d.param("keep_zeroth", &AllPole::keep_zeroth).doc("keep the 0th coefficient, the log gain");
  d.param("lifter", &AllPole::lifter).at_least(0).doc("HTK's liftering parameter, its default is 22; 0: none");
  d.param("lifter_exponent", &AllPole::lifter_exponent)
      .at_least(0)
      .doc("coefficient n times n to this, rastamat: 0.6; 0: none");
}

}  // namespace talkgraph
