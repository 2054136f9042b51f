#include "nodes/latent/linear_models.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"

namespace talkgraph {

namespace {

/// Gives every column the sign that makes its largest entry positive, so that
/// the result does not hang on the decomposition's choice.
void fix_signs(Eigen::MatrixXd& columns, Eigen::MatrixXd* along = nullptr) {
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::Index at = 0;
    columns.col(c).cwiseAbs().maxCoeff(&at);
    if (columns(at, c) >= 0) continue;
    columns.col(c) = -columns.col(c);
    if (along) along->col(c) = -along->col(c);
  }
}

Eigen::MatrixXd covariance(const Eigen::MatrixXd& centred) {
  return centred.transpose() * centred / static_cast<double>(centred.rows());
}

Eigen::MatrixXd shrunk(Eigen::MatrixXd covariance, Eigen::Index frames, double shrinkage) {
  const auto dims = covariance.rows();
  const double rho = std::min(1.0, shrinkage * static_cast<double>(dims) / static_cast<double>(dims + frames));
  const double mean = std::max(covariance.trace() / static_cast<double>(dims), 1e-300);
  covariance *= 1 - rho;
  covariance.diagonal().array() += (rho + 1e-10) * mean;
  return covariance;
}

void require_frames(const Eigen::MatrixXd& y) {
  if (y.rows() == 0 || y.cols() == 0) throw std::runtime_error("a latent model needs at least one frame of data");
  if (!y.allFinite()) throw std::runtime_error("a latent model cannot learn from values that are not finite");
}

}  // namespace

Ppca fit_ppca(const Eigen::MatrixXd& y, Eigen::Index d) {
  require_frames(y);
  Ppca model;
  model.mean = y.colwise().mean();
  const Eigen::MatrixXd centred = y.rowwise() - model.mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance(centred));
  const Eigen::Index dims = y.cols(), kept = std::min(d, dims);
  const Eigen::VectorXd variances = eigen.eigenvalues().reverse().cwiseMax(0);
  if (dims > kept) model.noise = variances.tail(dims - kept).mean();
  model.noise = std::max(model.noise, variance_floors(y, 1e-8).mean());
  Eigen::MatrixXd axes = eigen.eigenvectors().rowwise().reverse().leftCols(kept);
  fix_signs(axes);
  model.loadings.setZero(dims, d);
  model.loadings.leftCols(kept) =
      axes * (variances.head(kept).array() - model.noise).max(0.0).sqrt().matrix().asDiagonal();
  return model;
}

namespace {

void require_pairs(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) {
  require_frames(y);
  require_frames(z);
  if (y.rows() != z.rows())
    throw std::runtime_error(
        fmt::format("canonical correlations: {} frames of one stream but {} of the other: align them "
                    "first",
                    y.rows(), z.rows()));
}

/// Of centred columns: an orthonormal basis of their span and what takes them there, basis = columns · whitening.
struct Basis {
  explicit Basis(const Eigen::MatrixXd& columns) {
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXd& s = svd.singularValues();
    const double least = s(0) * 1e-12 * std::sqrt(static_cast<double>(columns.size()));
    const Eigen::Index rank = s(0) > 0 ? (s.array() > least).count() : 0;
    basis = svd.matrixU().leftCols(rank);
    whitening = svd.matrixV().leftCols(rank) * s.head(rank).cwiseInverse().asDiagonal();
  }
  Eigen::MatrixXd basis, whitening;
};

}  // namespace

Cca fit_cca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d) {
  require_pairs(y, z);
  Cca model{y.colwise().mean(), z.colwise().mean(), Eigen::MatrixXd::Zero(y.cols(), d),
            Eigen::MatrixXd::Zero(z.cols(), d), Eigen::VectorXd::Zero(d)};
  const Basis a(y.rowwise() - model.mean_y), b(z.rowwise() - model.mean_z);
  const Eigen::Index kept = std::min({d, a.basis.cols(), b.basis.cols()});
  if (kept == 0) return model;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a.basis.transpose() * b.basis, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::MatrixXd left = a.whitening * svd.matrixU().leftCols(kept), right = b.whitening * svd.matrixV().leftCols(kept);
  fix_signs(left, &right);
  model.directions_y.leftCols(kept) = left;
  model.directions_z.leftCols(kept) = right;
  model.correlations.head(kept) = svd.singularValues().head(kept).cwiseMin(1);
  return model;
}

Pcca fit_pcca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d, double shrinkage) {
  require_pairs(y, z);
  Pcca model;
  model.mean_y = y.colwise().mean();
  model.mean_z = z.colwise().mean();
  const Eigen::MatrixXd a = y.rowwise() - model.mean_y, b = z.rowwise() - model.mean_z;
  model.covariance_y = shrunk(covariance(a), y.rows(), shrinkage);
  model.covariance_z = shrunk(covariance(b), z.rows(), shrinkage);
  const Eigen::LLT<Eigen::MatrixXd> chol_y(model.covariance_y), chol_z(model.covariance_z);
  Eigen::MatrixXd cross = a.transpose() * b / static_cast<double>(y.rows());
  chol_y.matrixL().solveInPlace(cross);
  Eigen::MatrixXd whitened = cross.transpose();
  chol_z.matrixL().solveInPlace(whitened);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(whitened.transpose(), Eigen::ComputeThinU | Eigen::ComputeThinV);

  const Eigen::Index kept = std::min(d, svd.singularValues().size());
  Eigen::MatrixXd left = svd.matrixU().leftCols(kept), right = svd.matrixV().leftCols(kept);
  fix_signs(left, &right);
  model.correlations.setZero(d);
  model.correlations.head(kept) = svd.singularValues().head(kept).cwiseMin(1);
  model.directions_y.setZero(y.cols(), d);
  model.directions_z.setZero(z.cols(), d);
  model.directions_y.leftCols(kept) = chol_y.matrixU().solve(left);
  model.directions_z.leftCols(kept) = chol_z.matrixU().solve(right);
  const auto root = model.correlations.cwiseSqrt().asDiagonal();
  model.loadings_y = model.covariance_y * model.directions_y * root;
  model.loadings_z = model.covariance_z * model.directions_z * root;
  return model;
}

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
  if (root.info() != Eigen::Success)
    throw std::runtime_error(fmt::format(
        "PCCA: the {} × {} covariance of both streams is singular, as one determines the other (correlation {:.6g}): "
        "raise shrinkage or train on more frames",
        dims, dims, correlations.size() ? correlations(0) : 0));
  return log_normal(root, both.transpose());
}

Ppca TrainPpca::operator()(const Collected<Track>& tracks, Context& context) const {
  const Sequences data = measured_runs(tracks);
  const Ppca model = fit_ppca(data.frames, latent_dimension);
  const double log_likelihood = model.log_likelihood(data.frames).sum();
  if (!std::isfinite(log_likelihood))
    throw std::runtime_error(
        fmt::format("PPCA: the log-likelihood is {}: are values of the features huge?", log_likelihood));
  context.log(fmt::format("PPCA of {} frames: log-likelihood {:.6g}, noise variance {:.4g}", data.frames.rows(),
                          model.log_likelihood(data.frames).sum(), model.noise));
  return model;
}

void describe(Description<TrainPpca>& d) {
  d.type("latent.ppca").version(2).stored();
  d.summary("trains probabilistic principal components on tracks");
  d.source("Thesis §4.2.1, Eqns 4.3-4.4; Tipping and Bishop 1999");
  d.input("tracks", "whose measured frames are learnt from").output("model", "mean, loadings and noise");
  d.param("latent_dimension", &TrainPpca::latent_dimension).at_least(1).doc("loadings beyond the data's rank are zero");
}

Track ProjectPpca::operator()(const Ppca& model, const Track& track) const {
  require_frames_of(track, model.mean.size(), "the principal components");
  return {model.posterior_mean(track.values), track.rate, track.start, {}, track.lost};
}

void describe(Description<ProjectPpca>& d) {
  d.type("latent.ppca_project").version(1);
  d.summary("takes a track to the latent space of probabilistic principal components");
  d.source("Tipping and Bishop 1999");
  d.input("model", "trained on features of this kind").input("track", "of the features that the model was trained on");
  d.output("latents", "posterior means, T × d");
}

}  // namespace talkgraph
