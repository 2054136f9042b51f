#include "nodes/evaluate/lips.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/types/scheme.h"

namespace talkgraph {

Eigen::VectorXd point_distance(const LandmarkTrack& landmarks, const std::string& a, const std::string& b) {
  if (landmarks.frames.empty()) return {};
  const auto scheme = scheme_of(landmarks);
  const int from = scheme.point(a), to = scheme.point(b);
  Eigen::VectorXd out(static_cast<Eigen::Index>(landmarks.frames.size()));
  for (Eigen::Index t = 0; t < out.size(); ++t) {
    const Shape& shape = landmarks.frames[static_cast<std::size_t>(t)];
    if (shape.rows() != scheme.points())
      throw std::runtime_error(fmt::format("frame {} has {} points, its scheme {}", t, shape.rows(), scheme.points()));
    out[t] = (shape.row(from) - shape.row(to)).norm();
  }
  return out;
}

}  // namespace talkgraph
