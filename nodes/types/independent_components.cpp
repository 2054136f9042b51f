#include "nodes/types/independent_components.h"

#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {

Eigen::MatrixXd IndependentComponents::of(const Eigen::MatrixXd& rows) const {
  if (rows.cols() != dimension())
    throw std::runtime_error(
        fmt::format("a track of {} dimensions does not fit independent components learnt from {}: it was made with "
                    "another model",
                    rows.cols(), dimension()));
  return (rows.rowwise() - mean) * unmixing.transpose();
}

void fields(Archive& ar, IndependentComponents& c) {
  ar("mean", c.mean);
  ar("mixing", c.mixing);
  ar("unmixing", c.unmixing);
}

}  // namespace talkgraph
