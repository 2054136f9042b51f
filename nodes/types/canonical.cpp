#include "nodes/types/canonical.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nodes/types/stored_model.h"

namespace talkgraph {

Eigen::MatrixXd Pcca::posterior_mean(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const {
  const Eigen::VectorXd gain = correlations.array().sqrt() / (1 + correlations.array());
  return ((y.rowwise() - mean_y) * directions_y + (z.rowwise() - mean_z) * directions_z) * gain.asDiagonal();
}

Eigen::MatrixXd Pcca::posterior_mean_of_y(const Eigen::MatrixXd& y) const {
  return (y.rowwise() - mean_y) * directions_y * correlations.cwiseSqrt().asDiagonal();
}

Eigen::MatrixXd Pcca::posterior_mean_of_z(const Eigen::MatrixXd& z) const {
  return (z.rowwise() - mean_z) * directions_z * correlations.cwiseSqrt().asDiagonal();
}

Eigen::VectorXd Pcca::posterior_variance() const { return (1 - correlations.array()) / (1 + correlations.array()); }

Eigen::VectorXd Pcca::posterior_variance_of_one() const { return 1 - correlations.array(); }

Eigen::VectorXd Pcca::log_likelihood(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) const {
  const Eigen::Index dims_y = mean_y.size(), dims = dims_y + mean_z.size();
  Eigen::MatrixXd joint(dims, dims), both(y.rows(), dims);
  joint << covariance_y, loadings_y * loadings_z.transpose(), loadings_z * loadings_y.transpose(), covariance_z;
  both << y.rowwise() - mean_y, z.rowwise() - mean_z;
  const Eigen::LLT<Eigen::MatrixXd> root(joint);
  const bool determined = correlations.size() > 0 && correlations(0) > 1 - 1e-9;
  if (determined || root.info() != Eigen::Success)
    throw std::runtime_error(fmt::format(
        "PCCA: the {} × {} covariance of both streams is singular, as one determines the other (correlation {:.6g}): "
        "train on more frames, raise shrinkage, or leave out of one what the other holds",
        dims, dims, correlations.size() ? correlations(0) : 0));
  const Eigen::MatrixXd white = root.matrixL().solve(both.transpose());
  const double constant =
      static_cast<double>(dims) * std::log(2 * std::numbers::pi) + 2 * root.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (white.colwise().squaredNorm().transpose().array() + constant);
}

namespace {

/// What models with and without a density have in common.
template <class Model>
void check(const StoredModel& stored, const Model& m) {
  const Eigen::Index d = m.correlations.size();
  stored.matrix("mean_y", m.mean_y, 1, m.mean_y.size());
  stored.matrix("mean_z", m.mean_z, 1, m.mean_z.size());
  stored.matrix("directions_y", m.directions_y, m.mean_y.size(), d);
  stored.matrix("directions_z", m.directions_z, m.mean_z.size(), d);
  for (const double p : m.correlations) stored.require(p >= 0 && p <= 1, "correlations", "has a value beyond 0 to 1");
}

}  // namespace

void fields(Archive& ar, Cca& c) {
  ar("mean_y", c.mean_y);
  ar("mean_z", c.mean_z);
  ar("directions_y", c.directions_y);
  ar("directions_z", c.directions_z);
  ar("correlations", c.correlations);
  if (ar.loading()) check(StoredModel("canonical correlations"), c);
}

void fields(Archive& ar, Pcca& p) {
  ar("mean_y", p.mean_y);
  ar("mean_z", p.mean_z);
  ar("covariance_y", p.covariance_y);
  ar("covariance_z", p.covariance_z);
  ar("directions_y", p.directions_y);
  ar("directions_z", p.directions_z);
  ar("loadings_y", p.loadings_y);
  ar("loadings_z", p.loadings_z);
  ar("correlations", p.correlations);
  if (!ar.loading()) return;
  const StoredModel stored("probabilistic canonical correlations");
  check(stored, p);
  const Eigen::Index y = p.mean_y.size(), z = p.mean_z.size(), d = p.correlations.size();
  stored.matrix("covariance_y", p.covariance_y, y, y);
  stored.matrix("covariance_z", p.covariance_z, z, z);
  stored.matrix("loadings_y", p.loadings_y, y, d);
  stored.matrix("loadings_z", p.loadings_z, z, d);
}

}  // namespace talkgraph
