#pragma once

#include <Eigen/Core>

#include "graph/value.h"

namespace talkgraph {

/// One channel of sound, full scale ±1. Readers mix several channels down to
/// their mean; no sample is NaN or infinite.
struct Audio {
  Eigen::VectorXd samples;
  double rate = 16000;  ///< samples per second

  double seconds() const { return static_cast<double>(samples.size()) / rate; }
};
template <>
inline constexpr PortType port_type<Audio>{"Audio", 1};
void fields(Archive& ar, Audio& a);

}  // namespace talkgraph
