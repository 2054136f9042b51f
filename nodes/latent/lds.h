#pragma once

#include <limits>
#include <memory>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/lds.h"

namespace talkgraph {

/// What is known of the states of one sequence.
struct LdsPosterior {
  Eigen::MatrixXd means;                     ///< T × d
  std::vector<Eigen::MatrixXd> covariances;  ///< T of d × d
  std::vector<Eigen::MatrixXd> lagged;       ///< Cov(x_t, x_{t−1}) for t = 2..T; empty of a filter
  double log_likelihood = 0;                 ///< ln p(observed frames)
};
/// Kalman filter: states given the frames up to theirs. Frames in `lost`, in order, are not observed. T ≥ 1.
/// Covariances are products of roots, so that they stay positive semidefinite whatever the noise. Throws
/// std::runtime_error if a noise covariance of the model is not positive definite.
LdsPosterior kalman_filter(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost = {});
/// States given all frames (Rauch, Tung and Striebel 1965).
LdsPosterior kalman_smoother(const Lds& model, const Eigen::MatrixXd& frames,
                             const std::vector<std::int64_t>& lost = {});
/// A system that switches: the one that gives each frame, and leads from the state before to its own; that of the first
/// frame starts it. All have states and frames of the same dimensions.
using LdsRegimes = std::vector<const Lds*>;
LdsPosterior kalman_filter(const LdsRegimes& regimes, const Eigen::MatrixXd& frames,
                           const std::vector<std::int64_t>& lost = {});
LdsPosterior kalman_smoother(const LdsRegimes& regimes, const Eigen::MatrixXd& frames,
                             const std::vector<std::int64_t>& lost = {});

/// What a filter knows of the state of one frame.
struct LdsBelief {
  Eigen::VectorXd mean;        ///< d
  Eigen::MatrixXd covariance;  ///< d × d
  double log_likelihood = 0;   ///< of the frame, given those before
};
/// The filter's step alone, for those who choose the system of each frame as they go. Throws as kalman_filter().
class LdsFilter {
 public:
  explicit LdsFilter(Lds model);
  LdsFilter(LdsFilter&&) noexcept;
  ~LdsFilter();
  /// Of a frame, null if it is lost, and what was known of the one before, null for a first frame.
  LdsBelief operator()(const LdsBelief* before, const Eigen::RowVectorXd* frame) const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

/// The smoother for many sequences of one system, which must outlive it, without lost frames: gains and covariances do
/// not depend on the frames, and are computed once for sequences of equal length, the filter's for all.
class LdsSmoother {
 public:
  explicit LdsSmoother(const Lds& model);
  ~LdsSmoother();
  LdsPosterior operator()(const Eigen::MatrixXd& frames);

 private:
  struct Steps;
  const Lds& model_;
  std::unique_ptr<Steps> steps_;
};

/// The system of `dims` observed dimensions alone, from number `from` on.
Lds observed_part(const Lds& model, Eigen::Index from, Eigen::Index dims);

/// The frames that states (T × d) give without noise, T × D.
Eigen::MatrixXd observations(const Lds& model, const Eigen::MatrixXd& states);

/// What a system to be learnt keeps to.
struct LdsLimits {
  Eigen::Index apart = 0;  ///< the noise of that many first dimensions is independent of that of the others
  double radius = std::numeric_limits<double>::infinity();  ///< most |eigenvalue| of A: below 1 states come to rest
};

/// A linear dynamical system of tracks, every run of measured frames a sequence. Throws std::runtime_error, naming the
/// track, if none has a measured frame, on different dimensions and on values that are not finite.
struct TrainLds {
  int latent_dimension = 4;
  CovarianceKind covariance = CovarianceKind::full;
  double floor = 1e-3;
  double state_floor = 1e-6;
  int iterations = 100;
  double tolerance = 1e-5;

  Lds operator()(const Collected<Track>& tracks, Context& context) const;
  /// By expectation maximisation. It starts from PPCA of the frames, each stacked with the one before it, or with more
  /// if there are more state dimensions than two frames have: alone, standardised principal components are white, and
  /// PPCA finds no direction in them. `mean` is that of the frames and stays. Of one-frame sequences alone no dynamics
  /// are learnt: A and ν are 0 and Σ is I.
  Lds fit(const Sequences& data, Context& context, const LdsLimits& limits = {}) const;
};
void describe(Description<TrainLds>& d);

/// The states of a track and the frames that they give. Lost frames count as not observed, and stay marked.
struct SmoothLds {
  bool smooth = true;

  struct Out {
    Track states;  ///< means, T × d
    Track track;   ///< T × D
  };
  Out operator()(const Lds& model, const Track& track, Context& context) const;
};
void describe(Description<SmoothLds>& d);

}  // namespace talkgraph
