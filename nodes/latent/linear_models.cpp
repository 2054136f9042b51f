#include "nodes/latent/linear_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/paired.h"

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

Ppca TrainPpca::operator()(const Collected<Track>& tracks, Context& context) const {
  const Sequences data = measured_runs(tracks);
  Ppca model = fit_ppca(data.frames, latent_dimension);
  const double log_likelihood = model.log_likelihood(data.frames).sum();
  if (!std::isfinite(log_likelihood))
    throw std::runtime_error(
        fmt::format("PPCA: the log-likelihood is {}: are values of the features huge?", log_likelihood));
  context.log(fmt::format("PPCA of {} frames: log-likelihood {:.6g}, noise variance {:.4g}", data.frames.rows(),
                          log_likelihood, model.noise));
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

Cca TrainCca::operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const {
  const PairedFrames frames = paired_frames(audio, visual);
  Cca model = fit_cca(frames.audio, frames.visual, latent_dimension);
  context.log(fmt::format("canonical correlations of {} frames: {:.4g}", frames.audio.rows(),
                          fmt::join(model.correlations, ", ")));
  return model;
}

void describe(Description<TrainCca>& d) {
  d.type("latent.cca").version(1).stored();
  d.summary("finds the directions of two streams that correlate most");
  d.source("Thesis §4.2.6, Eqn 4.50, corrected as in docs/method.md §4; Hotelling 1936; Björck and Golub 1973");
  d.input("audio", "of the training sequences").input("visual", "of the same sequences, frame by frame");
  d.output("model", "means, directions and correlations");
  d.param("latent_dimension", &TrainCca::latent_dimension)
      .at_least(1)
      .doc("directions beyond the smaller stream's rank are zero");
}

Track ProjectCca::operator()(const Cca& model, const Track& track) const {
  const bool heard = stream == CanonicalStream::audio;
  const auto& mean = heard ? model.mean_y : model.mean_z;
  require_frames_of(track, mean.size(), "the canonical directions");
  const Eigen::MatrixXd projections =
      (track.values.rowwise() - mean) * (heard ? model.directions_y : model.directions_z);
  return {projections, track.rate, track.start, {}, track.lost};
}

void describe(Description<ProjectCca>& d) {
  d.type("latent.cca_project").version(1);
  d.summary("takes a track along canonical directions of its stream");
  d.source("Hotelling 1936");
  d.input("model", "of latent.cca").input("track", "of the features of that stream");
  d.output("projections", "T × d; over the training frames their squares sum to 1");
  d.param("stream", &ProjectCca::stream).doc("which of the model's two the track is of");
}

Pcca TrainPcca::operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const {
  const PairedFrames frames = paired_frames(audio, visual);
  Pcca model = fit_pcca(frames.audio, frames.visual, latent_dimension, shrinkage);
  context.log(
      fmt::format("PCCA of {} frames: correlations {:.4g}", frames.audio.rows(), fmt::join(model.correlations, ", ")));
  return model;
}

void describe(Description<TrainPcca>& d) {
  d.type("latent.pcca").version(1).stored();
  d.summary("trains probabilistic canonical correlation analysis of two streams");
  d.source("Thesis §4.3.1; Bach and Jordan 2005");
  d.input("audio", "of the training sequences").input("visual", "of the same sequences, frame by frame");
  d.output("model", "means, covariances, directions, loadings and correlations");
  d.param("latent_dimension", &TrainPcca::latent_dimension)
      .at_least(1)
      .doc("loadings beyond the smaller stream's dimension are zero");
  d.param("shrinkage", &TrainPcca::shrinkage)
      .at_least(0)
      .doc("of the covariances to a multiple of I, times dimensions / (dimensions + frames); 0: none");
}

std::optional<Track> ProjectPcca::operator()(const Pcca& model, const Track* audio, const Track* visual) const {
  if (!audio && !visual) return {};
  if (audio) require_frames_of(*audio, model.mean_y.size(), "the audio side of PCCA");
  if (visual) require_frames_of(*visual, model.mean_z.size(), "the visual side of PCCA");
  const Track& first = audio ? *audio : *visual;
  const Eigen::Index frames =
      visual ? common_frames("the track", first.frames(), "audio frames", visual->frames(), "visual frames")
             : first.frames();
  const auto there = [](const Track* track, Eigen::Index t) { return track && !track->is_lost(t); };
  Track out{Eigen::MatrixXd::Zero(frames, model.correlations.size()), first.rate, first.start, {}, {}};
  for (Eigen::Index t = 0; t < frames; ++t) {
    const bool heard = there(audio, t), seen = there(visual, t);
    if (heard && seen)
      out.values.row(t) = model.posterior_mean(audio->values.row(t), visual->values.row(t));
    else if (heard)
      out.values.row(t) = model.posterior_mean_of_y(audio->values.row(t));
    else if (seen)
      out.values.row(t) = model.posterior_mean_of_z(visual->values.row(t));
    else
      out.lost.push_back(t);
  }
  return out;
}

void describe(Description<ProjectPcca>& d) {
  d.type("latent.pcca_project").version(1);
  d.summary("takes one stream or both to the latent space of probabilistic canonical correlations");
  d.source("Bach and Jordan 2005");
  d.input("model", "of latent.pcca").input("audio", "of the features that the model was trained on");
  d.input("visual", "likewise");
  d.output("latents", "posterior means, T × d; nothing where neither stream is there");
}

}  // namespace talkgraph
