#pragma once

#include "graph/value.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// Linear regression from canonical variates of audio windows to visual windows, both of 2 context + 1 scaled frames.
struct WindowedCca {
  std::int64_t context = 0;        ///< frames on each side
  Scaling audio, visual;           ///< of frames
  Eigen::RowVectorXd audio_mean;   ///< of windows
  Eigen::RowVectorXd visual_mean;  ///< likewise
  Eigen::MatrixXd directions;      ///< audio window × d
  Eigen::MatrixXd weights;         ///< d × visual window
  Eigen::VectorXd correlations;    ///< of the training windows, falling
};
template <>
inline constexpr PortType port_type<WindowedCca>{"WindowedCca", 1};
void fields(Archive& ar, WindowedCca& c);

}  // namespace talkgraph
