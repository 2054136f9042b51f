#pragma once

#include "graph/value.h"
#include "nodes/types/sgpdm.h"
#include "nodes/types/yardsticks.h"

namespace talkgraph {

/// Gaussian process regression from stacked audio to visual parameters.
struct GpRegression {
  StackedInputs inputs;       ///< their scale also divides by the root of the number of inputs
  GaussianProcess process;    ///< of scaled visual parameters
  double log_likelihood = 0;  ///< of the training frames, natural logarithm; of Titsias' bound, the bound
  std::int64_t iterations = 0;
  std::int64_t frames = 0;    ///< trained on
  std::vector<double> trace;  ///< log_likelihood at the start and after each iteration
  std::string ended;          ///< why training stopped
  double jitter = 0;          ///< largest share of the mean variance added to a factorised matrix
};
template <>
inline constexpr PortType port_type<GpRegression>{"GpRegression", 2};
void fields(Archive& ar, GpRegression& g);

}  // namespace talkgraph
