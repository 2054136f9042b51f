#include "nodes/latent/gmm.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/latent/em.h"
#include "nodes/latent/k_means.h"
#include "nodes/latent/sequences.h"

namespace talkgraph {

namespace {

struct Posterior {
  Eigen::MatrixXd responsibilities;
  Eigen::VectorXd log_likelihood;
};

Posterior posterior(const GaussianMixture& mixture, const Eigen::MatrixXd& frames) {
  Posterior p{log_joint(mixture, frames), {}};
  p.log_likelihood = log_sum_rows(p.responsibilities);
  p.responsibilities.colwise() -= p.log_likelihood;
  for (double& r : p.responsibilities.reshaped()) r = std::exp(r);
  return p;
}

}  // namespace

Eigen::MatrixXd log_joint(const GaussianMixture& mixture, const Eigen::MatrixXd& frames) {
  Eigen::MatrixXd logs(frames.rows(), mixture.components());
  for (Eigen::Index k = 0; k < mixture.components(); ++k) {
    const Eigen::MatrixXd columns = (frames.rowwise() - mixture.means.row(k)).transpose();
    logs.col(k) =
        log_normal(mixture.covariances[static_cast<std::size_t>(k)], columns).array() + std::log(mixture.weights(k));
  }
  return logs;
}

Eigen::VectorXd log_likelihood(const GaussianMixture& mixture, const Eigen::MatrixXd& frames) {
  return log_sum_rows(log_joint(mixture, frames));
}

Eigen::MatrixXd responsibilities(const GaussianMixture& mixture, const Eigen::MatrixXd& frames) {
  Posterior p = posterior(mixture, frames);
  for (Eigen::Index n = 0; n < frames.rows(); ++n)
    if (!std::isfinite(p.log_likelihood(n)))
      throw std::runtime_error(fmt::format("frame {} is too far from every component of the mixture", n));
  return std::move(p.responsibilities);
}

void maximise(GaussianMixture& mixture, const Eigen::MatrixXd& frames, const Eigen::MatrixXd& responsibilities,
              const Eigen::VectorXd& floors, CovarianceKind kind) {
  const Eigen::RowVectorXd occupancies = responsibilities.colwise().sum();
  const double total = occupancies.sum();
  if (total < 1e-12) return;
  mixture.weights = occupancies.transpose() / total;
  for (Eigen::Index k = 0; k < mixture.components(); ++k) {
    if (occupancies(k) < 1e-12) continue;
    mixture.means.row(k) = responsibilities.col(k).transpose() * frames / occupancies(k);
    mixture.covariances[static_cast<std::size_t>(k)] =
        floored(scatter(frames.rowwise() - mixture.means.row(k), responsibilities.col(k), kind), floors);
  }
}

GaussianMixture start_mixture(const Eigen::MatrixXd& frames, Eigen::Index components, const Eigen::VectorXd& floors,
                              CovarianceKind kind, Random& random) {
  const Eigen::MatrixXd in = k_means(frames * floors.cwiseSqrt().cwiseInverse().asDiagonal(), components, random);
  GaussianMixture mixture{Eigen::VectorXd(in.cols()), Eigen::MatrixXd(in.cols(), frames.cols()),
                          std::vector<Eigen::MatrixXd>(static_cast<std::size_t>(in.cols()))};
  maximise(mixture, frames, in, floors, kind);
  return mixture;
}

Gmm TrainGmm::fit(const Eigen::MatrixXd& frames, Random& random, Context& context) const {
  const Eigen::VectorXd floors = variance_floors(frames, floor);
  Gmm model;
  model.mixture = start_mixture(frames, components, floors, covariance, random);
  Posterior given;
  const auto expect = [&] {
    given = posterior(model.mixture, frames);
    return given.log_likelihood.sum();
  };
  model.trace =
      run_em({iterations, tolerance}, frames.rows(), fmt::format("GMM of {} components", model.mixture.components()),
             context, expect, [&] { maximise(model.mixture, frames, given.responsibilities, floors, covariance); });
  return model;
}

Gmm TrainGmm::operator()(const Collected<Track>& tracks, Random& random, Context& context) const {
  return fit(measured_runs(tracks).frames, random, context);
}

void describe(Description<TrainGmm>& d) {
  d.type("latent.gmm").version(2).stored();
  d.summary("trains a Gaussian mixture model on tracks");
  d.source("Thesis §4.2.2, Eqns 4.5-4.6; expectation maximisation from k-means");
  d.input("tracks", "whose measured frames are learnt from").output("model", "weights, means and covariances");
  d.param("components", &TrainGmm::components).at_least(1).doc("fewer if there are fewer distinct frames");
  d.param("covariance", &TrainGmm::covariance).doc("full, or variances only");
  describe_em(d, "a component");
}

Track GmmResponsibilities::operator()(const Gmm& model, const Track& track) const {
  require_frames_of(track, model.mixture.dimension(), "the mixture");
  Track out{Eigen::MatrixXd(track.frames(), model.mixture.components()), track.rate, track.start, {}, track.lost};
  Eigen::MatrixXd frames = track.values;
  for (const auto t : track.lost) frames.row(t) = model.mixture.means.row(0);
  out.values = responsibilities(model.mixture, frames);
  for (const auto t : track.lost) out.values.row(t) = model.mixture.weights.transpose();
  return out;
}

void describe(Description<GmmResponsibilities>& d) {
  d.type("latent.gmm_responsibilities").version(2);
  d.summary("probabilities that frames are of each component of a mixture");
  d.source("Thesis §4.2.2, Eqns 4.6-4.7, corrected: the denominator sums m_j");
  d.input("model", "trained on features of this kind").input("track", "of the features that the model was trained on");
  d.output("responsibilities", "T × M, rows sum to 1");
}

}  // namespace talkgraph
