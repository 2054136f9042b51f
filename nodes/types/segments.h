#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A stretch of frames that one state speaks for.
struct Segment {
  std::string label;       ///< of the state: phones joined by '-', oldest first ("k-ae-t"), or one phone
  std::int64_t start = 0;  ///< first frame
  std::int64_t length = 0;
};
template <>
inline constexpr bool is_row<Segment> = true;
void fields(Archive& ar, Segment& s);

/// Non-overlapping segments in time order that cover every frame (docs/method.md §5).
struct SegmentTrack {
  std::vector<Segment> segments;
  std::int64_t frames = 0;
  Rational rate{25};
};
template <>
inline constexpr PortType port_type<SegmentTrack>{"SegmentTrack", 1};
void fields(Archive& ar, SegmentTrack& s);

/// The training windows of one state: equal frames of audio and visual features.
struct StateData {
  std::string label;
  std::vector<Eigen::MatrixXd> audio;   ///< one a window, T_i × D_Y
  std::vector<Eigen::MatrixXd> visual;  ///< one a window, T_i × D_Z
};
template <>
inline constexpr PortType port_type<StateData>{"StateData", 1};
void fields(Archive& ar, StateData& s);

}  // namespace talkgraph
