#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A feature track: one row a frame (T × D). The centre of frame t lies at
/// start + t / rate seconds. Speech features, visual parameters, any trajectory.
struct Track {
  Eigen::MatrixXd values;
  Rational rate{25};               ///< frames per second
  double start = 0;                ///< centre of the first frame, seconds
  std::vector<std::string> names;  ///< of the dimensions; may be empty
  /// Frames, in order, whose values were bridged, not measured: nothing is learnt from them or scored on them.
  std::vector<std::int64_t> lost = {};

  Eigen::Index frames() const { return values.rows(); }
  Eigen::Index dimension() const { return values.cols(); }
  bool is_lost(Eigen::Index t) const { return std::binary_search(lost.begin(), lost.end(), t); }
  double time(Eigen::Index t) const { return start + static_cast<double>(t) / rate.value(); }
};
template <>
inline constexpr PortType port_type<Track>{"Track", 2};
void fields(Archive& ar, Track& t);

/// Which frames of a track count (1) or do not (0): speech frames, sound frames.
struct Mask {
  std::vector<std::int64_t> frames;
};
template <>
inline constexpr PortType port_type<Mask>{"Mask", 1};
void fields(Archive& ar, Mask& m);

}  // namespace talkgraph
