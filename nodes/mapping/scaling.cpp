#include "nodes/mapping/scaling.h"

namespace talkgraph {

Scaling scaling_of(const Eigen::MatrixXd& frames) {
  Scaling s;
  s.mean = frames.colwise().mean();
  const Eigen::RowVectorXd variance =
      (frames.rowwise() - s.mean).colwise().squaredNorm() / static_cast<double>(frames.rows());
  s.deviation = variance.cwiseSqrt();
  // Below this only rounding varies.
  const Eigen::RowVectorXd least = 1e-10 * s.mean.cwiseAbs();
  s.deviation = (s.deviation.array() > least.array()).select(s.deviation, 0.0);
  return s;
}

std::pair<Scaling, Scaling> split(const Scaling& scaling, Eigen::Index dims) {
  const Eigen::Index others = scaling.mean.size() - dims;
  return {{scaling.mean.head(dims), scaling.deviation.head(dims)},
          {scaling.mean.tail(others), scaling.deviation.tail(others)}};
}

Eigen::MatrixXd scaled(const Scaling& scaling, const Eigen::MatrixXd& frames) {
  const Eigen::RowVectorXd inverse =
      (scaling.deviation.array() > 0).select(scaling.deviation.cwiseInverse().array(), 0.0);
  return (frames.rowwise() - scaling.mean) * inverse.asDiagonal();
}

Eigen::MatrixXd restored(const Scaling& scaling, const Eigen::MatrixXd& frames) {
  return (frames * scaling.deviation.asDiagonal()).rowwise() + scaling.mean;
}

}  // namespace talkgraph
