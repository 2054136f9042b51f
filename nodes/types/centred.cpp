#include "nodes/types/centred.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talkgraph {

namespace {

constexpr double rounding = 1e-13, infinity = std::numeric_limits<double>::infinity();

}  // namespace

CentredFrames centred(const Eigen::MatrixXd& frames) {
  CentredFrames c;
  c.values.setZero(frames.rows(), frames.cols());
  c.mean.setZero(frames.cols());
  c.deviation.setZero(frames.cols());
  for (Eigen::Index i = 0; i < frames.cols(); ++i) {
    const auto column = frames.col(i).array();
    const Eigen::Array<bool, Eigen::Dynamic, 1> there = !column.isNaN();
    const double count = static_cast<double>(there.count());
    const double least = there.select(column, infinity).minCoeff(), most = there.select(column, -infinity).maxCoeff();
    c.mean[i] = there.select(column, 0.0).sum() / count;
    if (!(most - least > rounding * std::max(std::abs(least), std::abs(most)))) continue;
    c.values.col(i) = there.select(column - c.mean[i], 0.0);
    c.deviation[i] = c.values.col(i).stableNorm() / std::sqrt(count);
  }
  return c;
}

}  // namespace talkgraph
