#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/latent/normal.h"
#include "nodes/types/gmm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// ln (weight_k N(y_n | mean_k, Σ_k)), N × M.
Eigen::MatrixXd log_joint(const GaussianMixture& mixture, const Eigen::MatrixXd& frames);
/// ln p(y_n) of every row.
Eigen::VectorXd log_likelihood(const GaussianMixture& mixture, const Eigen::MatrixXd& frames);
/// p(component | y_n), N × M; rows sum to 1. Throws std::runtime_error on a frame that no component can explain.
Eigen::MatrixXd responsibilities(const GaussianMixture& mixture, const Eigen::MatrixXd& frames);

/// The likeliest mixture given responsibilities (N × M, any total), covariances staying above `floors` (see `floored`).
/// A component without any keeps its mean and covariance.
void maximise(GaussianMixture& mixture, const Eigen::MatrixXd& frames, const Eigen::MatrixXd& responsibilities,
              const Eigen::VectorXd& floors, CovarianceKind kind);
/// The likeliest mixture given clusters by k-means of frames in units of the floors' roots; fewer components if there
/// are fewer distinct frames.
GaussianMixture start_mixture(const Eigen::MatrixXd& frames, Eigen::Index components, const Eigen::VectorXd& floors,
                              CovarianceKind kind, Random& random);

/// A Gaussian mixture of the measured frames of all tracks. Throws std::runtime_error, naming the track, if none has a
/// measured frame, on different dimensions and on values that are not finite.
struct TrainGmm {
  int components = 8;
  CovarianceKind covariance = CovarianceKind::full;
  double floor = 1e-3;
  int iterations = 100;
  double tolerance = 1e-5;

  Gmm operator()(const Collected<Track>& tracks, Random& random, Context& context) const;
  /// By expectation maximisation from `start_mixture`. Frames are finite and N ≥ 1.
  Gmm fit(const Eigen::MatrixXd& frames, Random& random, Context& context) const;
};
void describe(Description<TrainGmm>& d);

/// Which component each frame is of, as probabilities, T × M. Lost frames count as not observed, which leaves the
/// weights, and stay marked.
struct GmmResponsibilities {
  Track operator()(const Gmm& model, const Track& track) const;
};
void describe(Description<GmmResponsibilities>& d);

}  // namespace talkgraph
