#include "nodes/speech/spectrum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace talkgraph {
namespace {

Eigen::Index dft_size(Eigen::Index length, int wanted) {
  const auto next = std::bit_ceil(static_cast<std::size_t>(std::max<Eigen::Index>(2, length)));
  const auto size = wanted ? static_cast<std::size_t>(wanted) : next;
  if (size < next || !std::has_single_bit(size))
    throw std::invalid_argument("the size of a DFT must be a power of two that holds a frame of " +
                                std::to_string(length) + " samples, got " + std::to_string(size));
  return static_cast<Eigen::Index>(size);
}

}  // namespace

Spectrum ShortTimeSpectrum::operator()(const Frames& frames) const {
  const auto count = frames.values.rows(), length = frames.values.cols(), n = dft_size(length, size), half = n / 2;
  Spectrum out;
  out.rate = frames.rate;
  out.start = frames.start;
  out.sample_rate = frames.sample_rate;
  out.power = kind != SpectrumKind::magnitude;
  out.values.resize(count, half + 1);
  const Eigen::RowVectorXd weights = window.weights(length);
  // Blocks stay in the processor's cache; a call makes one plan for its block.
  const auto block = std::min<Eigen::Index>(64, count);
  FrameMatrix in = FrameMatrix::Zero(block, n), bins(block, n);
  for (Eigen::Index first = 0; first < count; first += block) {
    const auto rows = std::min(block, count - first);
    in.topLeftCorner(rows, length) = frames.values.middleRows(first, rows) * weights.asDiagonal();
    cv::Mat from(static_cast<int>(rows), static_cast<int>(n), CV_64F, in.data());
    cv::Mat to(static_cast<int>(rows), static_cast<int>(n), CV_64F, bins.data());
    cv::dft(from, to, cv::DFT_ROWS);
    // A row holds Re 0, Re 1, Im 1, Re 2, Im 2 ... Re n/2.
    for (Eigen::Index t = 0; t < rows; ++t) {
      const double* bin = bins.row(t).data();
      auto row = out.values.row(first + t);
      row[0] = bin[0] * bin[0];
      for (Eigen::Index k = 1; k < half; ++k) row[k] = bin[2 * k - 1] * bin[2 * k - 1] + bin[2 * k] * bin[2 * k];
      row[half] = bin[n - 1] * bin[n - 1];
      if (kind == SpectrumKind::magnitude) row = row.cwiseSqrt();
      if (kind == SpectrumKind::periodogram) row /= static_cast<double>(n);
    }
  }
  return out;
}

void describe(Description<ShortTimeSpectrum>& d) {
  d.type("speech.spectrum").version(2).summary("spectrum of each frame").source("Thesis §3.2");
  d.input("frames", "T x samples").output("spectrum", "T x bins, from 0 to the Nyquist frequency");
  d.param("window", &ShortTimeSpectrum::window).doc("what the frames are weighed with first; none by default");
  d.param("kind", &ShortTimeSpectrum::kind)
      .doc(
          "magnitude |DFT| (HTK), power |DFT|² (Kaldi, rastamat; HTK with USEPOWER), or periodogram |DFT|² / size "
          "(python_speech_features)");
  d.param("size", &ShortTimeSpectrum::size).at_least(0).doc("points of the DFT; 0: the next power of two");
}

}  // namespace talkgraph
