#include "nodes/evaluate/lips.h"

#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {

Eigen::VectorXd point_distance(const LandmarkTrack& landmarks, int a, int b) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(landmarks.frames.size()));
  for (Eigen::Index t = 0; t < out.size(); ++t) {
    const Shape& shape = landmarks.frames[static_cast<std::size_t>(t)];
    if (shape.rows() <= std::max(a, b))
      throw std::runtime_error(fmt::format("landmarks of {} points have no points {} and {}: name those of your scheme",
                                           shape.rows(), a, b));
    out[t] = (shape.row(a) - shape.row(b)).norm();
  }
  return out;
}

}  // namespace talkgraph
