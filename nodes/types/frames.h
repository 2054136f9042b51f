#pragma once

#include <Eigen/Core>

#include "graph/value.h"

namespace talkgraph {

/// One row a frame, each row in one piece of memory.
using FrameMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sound cut into overlapping frames: one row a frame (T × N samples).
struct Frames {
  FrameMatrix values;
  Rational rate{100};  ///< frames per second
  double start = 0;    ///< centre of the first frame, seconds
  double sample_rate = 16000;
};
template <>
inline constexpr PortType port_type<Frames>{"Frames", 1};
void fields(Archive& ar, Frames& f);

/// Spectra of frames: one row a frame, bins from 0 to the Nyquist frequency.
struct Spectrum {
  FrameMatrix values;
  Rational rate{100};
  double start = 0;
  double sample_rate = 16000;
  bool power = false;  ///< |DFT|² instead of |DFT|

  double bin_hz() const { return sample_rate / 2 / static_cast<double>(values.cols() - 1); }
};
template <>
inline constexpr PortType port_type<Spectrum>{"Spectrum", 1};
void fields(Archive& ar, Spectrum& s);

/// Where the filters of a bank lie.
struct Bands {
  Eigen::VectorXd centres;  ///< Hz
  double nyquist = 8000;    ///< of the sound, Hz
};
template <>
inline constexpr PortType port_type<Bands>{"Bands", 1};
void fields(Archive& ar, Bands& b);

}  // namespace talkgraph
