#include "nodes/speech/spectrum.h"

#include <bit>
#include <complex>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

namespace talkgraph {

Spectrum ShortTimeSpectrum::operator()(const Frames& frames) const {
  const auto length = frames.values.cols();
  const auto n =
      size ? static_cast<Eigen::Index>(size)
           : static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(std::max<Eigen::Index>(2, length))));
  if (n < length || !std::has_single_bit(static_cast<std::size_t>(n)))
    throw std::invalid_argument("the size of a DFT must be a power of two that holds a frame of " +
                                std::to_string(length) + " samples, got " + std::to_string(n));
  Spectrum out;
  out.rate = frames.rate;
  out.start = frames.start;
  out.sample_rate = frames.sample_rate;
  out.power = kind == SpectrumKind::power;
  out.values.resize(frames.values.rows(), n / 2 + 1);
  Eigen::FFT<double> fft(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd frame = Eigen::VectorXd::Zero(n);
  Eigen::VectorXcd bins(n / 2 + 1);
  for (Eigen::Index t = 0; t < frames.values.rows(); ++t) {
    frame.head(length) = frames.values.row(t).transpose();
    fft.fwd(bins, frame);
    out.values.row(t) = out.power ? bins.cwiseAbs2().transpose() : Eigen::RowVectorXd(bins.cwiseAbs().transpose());
  }
  return out;
}

void describe(Description<ShortTimeSpectrum>& d) {
  d.type("speech.spectrum").summary("magnitude or power spectrum of each frame").source("Thesis §3.2");
  d.input("frames").output("spectrum");
  d.param("kind", &ShortTimeSpectrum::kind).doc("magnitude |DFT| (HTK's choice for MFCC) or power |DFT|²");
  d.param("size", &ShortTimeSpectrum::size).at_least(0).doc("points of the DFT; 0: the next power of two");
}

}  // namespace talkgraph
