#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/maximisation.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

enum class OutputScaling {
  per_dimension,  ///< every dimension divided by its own standard deviation
  common,         ///< all by the root mean square of the standard deviations: their ratios are kept
  none
};
template <>
inline constexpr EnumNames<OutputScaling, 3> enum_names<OutputScaling>{{{OutputScaling::per_dimension, "per_dimension"},
                                                                        {OutputScaling::common, "common"},
                                                                        {OutputScaling::none, "none"}}};

enum class CovarianceApproximation { full, dtc, fitc, pitc, variational };
template <>
inline constexpr EnumNames<CovarianceApproximation, 5> enum_names<CovarianceApproximation>{
    {{CovarianceApproximation::full, "full"},
     {CovarianceApproximation::dtc, "dtc"},
     {CovarianceApproximation::fitc, "fitc"},
     {CovarianceApproximation::pitc, "pitc"},
     {CovarianceApproximation::variational, "variational"}}};

enum class ObservationKernel {
  rbf,  ///< one inverse width
  ard   ///< one a latent dimension
};
template <>
inline constexpr EnumNames<ObservationKernel, 2> enum_names<ObservationKernel>{
    {{ObservationKernel::rbf, "rbf"}, {ObservationKernel::ard, "ard"}}};

enum class LatentDynamics { none, absolute, difference, time, phase };
template <>
inline constexpr EnumNames<LatentDynamics, 5> enum_names<LatentDynamics>{{{LatentDynamics::none, "none"},
                                                                          {LatentDynamics::absolute, "absolute"},
                                                                          {LatentDynamics::difference, "difference"},
                                                                          {LatentDynamics::time, "time"},
                                                                          {LatentDynamics::phase, "phase"}}};

enum class BackConstraintKind { none, mlp, kbr };
template <>
inline constexpr EnumNames<BackConstraintKind, 3> enum_names<BackConstraintKind>{
    {{BackConstraintKind::none, "none"}, {BackConstraintKind::mlp, "mlp"}, {BackConstraintKind::kbr, "kbr"}}};

enum class FirstPoint {
  variance,  ///< a variance of its own
  noise      ///< that of the dynamics' noise, β_dyn⁻¹
};
template <>
inline constexpr EnumNames<FirstPoint, 2> enum_names<FirstPoint>{
    {{FirstPoint::variance, "variance"}, {FirstPoint::noise, "noise"}}};

/// What training has in common for one and for two observed streams: its
/// parameters, and the maximisation of Eqn 4.69 over latent points (or a
/// back-constraint's parameters), inducing points and kernel parameters.
///
/// Observation kernels are RBF (or ARD) + bias + white, that of the dynamics RBF + linear + white, whose RBF starts at
/// variance 0.1, or 1 where its input is time, which alone says where a point is. A process of at most
/// `inducing` frames is exact whatever the approximation. Without dynamics latent points have no prior (or N(0, I),
/// `latent_prior`): the objective is then the density of the frames, where nothing weighs a stream or a parameter. The
/// latent dimension is lowered to the largest stream's and to N − 1 (at least 1), with a warning. Scales are as
/// output_scale() has them. Data that do not vary at all are not optimised: the model answers with their mean, and a
/// warning says so.
struct LatentTraining : Maximisation {
  int latent_dimension = 3;
  ObservationKernel kernel = ObservationKernel::rbf;
  CovarianceApproximation approximation = CovarianceApproximation::fitc;
  int inducing = 100;
  LatentDynamics dynamics = LatentDynamics::absolute;
  bool dynamics_bias = true;
  double dynamics_inverse_width = 1;
  FirstPoint first_point = FirstPoint::variance;
  double first_variance = 0.1;
  bool latent_prior = false;
  BackConstraintKind back_constraint = BackConstraintKind::none;
  int hidden_units = 20;
  double kbr_inverse_width = 1;
  bool learn_scale = false;
  double noise = 0.5;
  double minimum_noise = 1e-3;
  double prior_deviation = 0.2;
  std::vector<std::string> fixed = {"dynamics.inverse_width"};
};

/// What outputs of these standard deviations (1 × D) are divided by. Those that do not vary keep 1, or the common
/// scale; where none varies, all have 1.
Eigen::RowVectorXd output_scale(const Eigen::RowVectorXd& deviation, OutputScaling scaling);
/// The warning of a model of frames that are all alike.
std::string nothing_varies(const std::string& subject, Eigen::Index frames);

/// A stream of frames to be observed.
struct TrainingStream {
  std::string name;
  Eigen::MatrixXd frames;  ///< N × D
  OutputScaling scaling = OutputScaling::per_dimension;
  double weight = 1;  ///< of its log-likelihood
};

/// Latent points (N × d) to start from, given all streams' scaled frames.
using StartValues = std::function<Eigen::MatrixXd(const std::vector<Eigen::MatrixXd>& scaled, Eigen::Index d)>;

/// What training gives; one process a stream.
struct TrainedLatents {
  Eigen::MatrixXd latents, first_frames;  ///< N × d; the first stream, scaled
  std::vector<GaussianProcess> processes;
  std::optional<GaussianProcess> dynamics;
  DynamicsForm form = DynamicsForm::absolute;
  std::optional<BackConstraint> back_constraint;
  double dynamics_weight = 1, first_variance = 1, jitter = 0;
  OptimiserReport report;
  std::string ended;  ///< why

  /// Moves all but the streams to a model of one or of two.
  template <class Model>
  void move_to(Model& model) {
    model.latents = std::move(latents);
    model.dynamics = std::move(dynamics);
    model.form = form;
    model.back_constraint = std::move(back_constraint);
    model.dynamics_bias = dynamics_weight;
    model.first_variance = first_variance;
    model.log_likelihood = -report.cost;
    model.jitter = jitter;
    for (const double cost : report.trace) model.trace.push_back(-cost);
    model.ended = ended;
  }
};
/// `subject` ("state \"t\"") stands in messages. Throws std::invalid_argument if `fixed` names an unknown parameter,
/// FactorisationError where training cannot begin.
TrainedLatents train_latents(const LatentTraining& options, const std::string& subject,
                             const std::vector<TrainingStream>& streams, const std::vector<std::int64_t>& lengths,
                             const StartValues& start, Context& context);

/// The likelihood of N frames in sequences of these lengths; PITC has blocks of at most `most` frames.
std::unique_ptr<GpLikelihood> make_likelihood(CovarianceApproximation approximation,
                                              const std::vector<std::int64_t>& lengths, Eigen::Index most);
/// Rows at even distances, for inducing points to start from.
Eigen::MatrixXd spread(const Eigen::MatrixXd& x, Eigen::Index count);

struct ApproximateGp {
  std::unique_ptr<GpLikelihood> likelihood;
  Eigen::MatrixXd inducing;  ///< points to start from; none where the process is exact
};
/// Of inputs N × d in sequences of these lengths; exact if there are no more of them than `inducing` points.
ApproximateGp approximate_gp(CovarianceApproximation approximation, const Eigen::MatrixXd& x,
                             const std::vector<std::int64_t>& lengths, Eigen::Index inducing);

template <class Node>
void describe_training(Description<Node>& d) {
  const auto param = [&]<class M>(const char* name, M LatentTraining::*member) {
    return d.param(name, static_cast<M Node::*>(member));
  };
  param("latent_dimension", &LatentTraining::latent_dimension)
      .at_least(1)
      .doc("lowered to the largest stream's dimension and to the number of frames less one");
  param("kernel", &LatentTraining::kernel)
      .doc("of the observed streams, beside bias and noise: RBF of one inverse width, or of one a latent dimension");
  param("approximation", &LatentTraining::approximation)
      .doc(
          "of covariances of more frames than inducing points; blocks of PITC have as many frames as there are "
          "inducing points, at most");
  param("inducing", &LatentTraining::inducing).at_least(1).doc("inducing points of each process");
  param("dynamics", &LatentTraining::dynamics)
      .doc(
          "a process from each latent point to the next, or to the difference from it; or from the frame's number in "
          "its window (time), or from the share of the window that has passed (phase), to the point; none: a GPLVM");
  param("dynamics_bias", &LatentTraining::dynamics_bias)
      .doc("the dynamics weigh larger dimension / latent dimension, in synthesis too");
  param("dynamics_inverse_width", &LatentTraining::dynamics_inverse_width)
      .positive()
      .doc("of the RBF part of the dynamics kernel");
  param("first_point", &LatentTraining::first_point)
      .doc("variance of the prior of each sequence's first latent point: first_variance, or the noise of the dynamics");
  param("first_variance", &LatentTraining::first_variance)
      .positive()
      .doc("of the prior of each sequence's first latent point");
  param("latent_prior", &LatentTraining::latent_prior)
      .doc("without dynamics every latent point has the prior N(0, I), of the weight of the dynamics; off: none");
  param("back_constraint", &LatentTraining::back_constraint)
      .doc("latent points as a function of the first stream: a perceptron, or kernel-based regression");
  param("hidden_units", &LatentTraining::hidden_units).at_least(1).doc("of the perceptron");
  param("kbr_inverse_width", &LatentTraining::kbr_inverse_width)
      .positive()
      .doc("of the RBF kernel of the regression, in scaled units");
  param("learn_scale", &LatentTraining::learn_scale).doc("the outputs' scales are optimised, too");
  param("noise", &LatentTraining::noise).positive().doc("noise variance to start from, in scaled units");
  param("minimum_noise", &LatentTraining::minimum_noise).at_least(0).doc("noise variance stays above this");
  param("prior_deviation", &LatentTraining::prior_deviation)
      .at_least(0)
      .doc("standard deviation of a normal prior on log kernel parameters about their start values; 0: none");
  param("fixed", &LatentTraining::fixed)
      .doc("what is not optimised: latents (or the back-constraint), inducing, or <stream or dynamics>.<parameter>");
  describe_maximisation(d);
}

}  // namespace talkgraph
