#include "nodes/latent/k_means.h"

#include <algorithm>
#include <vector>

namespace talkgraph {

namespace {

/// The first row at which the running sum of weights passes a random share of it.
Eigen::Index draw(const Eigen::VectorXd& weights, Random& random) {
  double left = random.uniform() * weights.sum();
  Eigen::Index at = 0, last = 0;
  for (; at < weights.size(); ++at) {
    if (weights(at) > 0) last = at;
    left -= weights(at);
    if (left < 0 && weights(at) > 0) return at;
  }
  return last;
}

Eigen::MatrixXd start(const Eigen::MatrixXd& rows, Eigen::Index clusters, Random& random) {
  clusters = std::min(clusters, rows.rows());
  Eigen::MatrixXd centres(clusters, rows.cols());
  Eigen::VectorXd nearest = Eigen::VectorXd::Ones(rows.rows());
  for (Eigen::Index k = 0; k < clusters; ++k) {
    if (nearest.maxCoeff() == 0) return centres.topRows(k);
    centres.row(k) = rows.row(draw(nearest, random));
    const Eigen::VectorXd distance = (rows.rowwise() - centres.row(k)).rowwise().squaredNorm();
    nearest = k == 0 ? distance : nearest.cwiseMin(distance);
  }
  return centres;
}

std::vector<Eigen::Index> assign(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& centres) {
  Eigen::MatrixXd distance = -2 * rows * centres.transpose();
  distance.rowwise() += centres.rowwise().squaredNorm().transpose();
  std::vector<Eigen::Index> labels(static_cast<std::size_t>(rows.rows()));
  for (std::size_t n = 0; n < labels.size(); ++n) distance.row(static_cast<Eigen::Index>(n)).minCoeff(&labels[n]);
  return labels;
}

Eigen::MatrixXd indicators(const std::vector<Eigen::Index>& labels, Eigen::Index clusters) {
  Eigen::MatrixXd in = Eigen::MatrixXd::Zero(std::ssize(labels), clusters);
  for (std::size_t n = 0; n < labels.size(); ++n) in(static_cast<Eigen::Index>(n), labels[n]) = 1;
  return in;
}

Eigen::MatrixXd without_empty(Eigen::MatrixXd in) {
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < in.cols(); ++k)
    if ((in.col(k).array() > 0).any()) in.col(kept++) = in.col(k);
  return in.leftCols(kept);
}

struct Clusters {
  Eigen::MatrixXd in;  ///< N × K
  double spread;       ///< squared distances from the clusters' means
};

Clusters lloyd(const Eigen::MatrixXd& rows, Eigen::MatrixXd centres) {
  std::vector<Eigen::Index> labels;
  Eigen::MatrixXd in;
  for (int i = 0; i < 30; ++i) {
    std::vector<Eigen::Index> next = assign(rows, centres);
    if (next == labels) break;
    labels = std::move(next);
    in = indicators(labels, centres.rows());
    const Eigen::MatrixXd sums = in.transpose() * rows;
    for (Eigen::Index k = 0; k < centres.rows(); ++k)
      if (const double size = in.col(k).sum(); size > 0) centres.row(k) = sums.row(k) / size;
  }
  return {without_empty(in), (rows - in * centres).squaredNorm()};
}

}  // namespace

Eigen::MatrixXd k_means(const Eigen::MatrixXd& rows, Eigen::Index clusters, Random& random, int starts) {
  const Eigen::MatrixXd centred = rows.rowwise() - rows.colwise().mean();
  Clusters best = lloyd(centred, start(centred, clusters, random));
  for (int i = 1; i < starts; ++i) {
    Clusters next = lloyd(centred, start(centred, clusters, random));
    if (next.spread < best.spread) best = std::move(next);
  }
  return std::move(best.in);
}

}  // namespace talkgraph
