#include "nodes/latent/latent_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/latent/clock.h"
#include "nodes/latent/compact.h"
#include "nodes/latent/sequences.h"
#include "nodes/latent/sgpdm_objective.h"
#include "nodes/types/centred.h"

namespace talkgraph {

namespace {

using Lengths = std::vector<std::int64_t>;

/// Frames less their mean, and the scale they are to be divided by.
struct ScaledFrames : CentredFrames {
  Eigen::RowVectorXd scale;
  ScaledFrames(const TrainingStream& s) : CentredFrames(centred(s.frames)), scale(output_scale(deviation, s.scaling)) {}
  Eigen::MatrixXd scaled() const { return values.array().rowwise() / scale.array(); }
};

/// d as the data allow it.
Eigen::Index allowed_dimension(int wanted, const std::string& subject, const std::vector<TrainingStream>& streams,
                               Context& context) {
  const Eigen::Index frames = streams[0].frames.rows();
  Eigen::Index largest = 0;
  for (const auto& s : streams) largest = std::max(largest, s.frames.cols());
  const Eigen::Index d = std::max<Eigen::Index>(1, std::min<Eigen::Index>({wanted, largest, frames - 1}));
  if (d < wanted)
    context.warn(
        fmt::format("{}: latent_dimension is {} and not {}, as {} frames of at most {} dimensions have no more",
                    subject, d, wanted, frames, largest));
  return d;
}

Lengths lengths_of_steps(Lengths lengths) {
  for (auto& length : lengths) --length;
  std::erase(lengths, 0);
  return lengths;
}

GpStream stream_of(const LatentTraining& options, std::string name, Kernel kernel, const Eigen::MatrixXd& inputs,
                   const Lengths& lengths, double weight) {
  kernel.terms.push_back(WhiteTerm{std::max(options.noise, 2 * options.minimum_noise), options.minimum_noise});
  auto [likelihood, inducing] = approximate_gp(options.approximation, inputs, lengths, options.inducing);
  return {std::move(name), std::move(kernel), std::move(inducing), std::move(likelihood), weight};
}

std::optional<BackProjection> back_projection(const LatentTraining& options, const Eigen::MatrixXd& frames,
                                              const Eigen::MatrixXd& start) {
  switch (options.back_constraint) {
    case BackConstraintKind::none:
      break;
    case BackConstraintKind::mlp:
      return BackProjection(perceptron(frames, start, options.hidden_units), frames);
    case BackConstraintKind::kbr:
      return BackProjection(kernel_regression(frames, start, options.kbr_inverse_width), frames);
  }
  return std::nullopt;
}

DynamicsForm form_of(LatentDynamics dynamics) {
  switch (dynamics) {
    case LatentDynamics::difference:
      return DynamicsForm::difference;
    case LatentDynamics::time:
      return DynamicsForm::time;
    case LatentDynamics::phase:
      return DynamicsForm::phase;
    case LatentDynamics::none:
    case LatentDynamics::absolute:
      break;
  }
  return DynamicsForm::absolute;
}

Kernel dynamics_kernel(const LatentTraining& options) {
  const double variance = is_timed(form_of(options.dynamics)) ? 1 : 0.1;
  return {{RbfTerm{variance, options.dynamics_inverse_width}, LinearTerm{1}}};
}

/// `fixed` may name parameters of dynamics whether or not there are any.
std::vector<std::string> fixed_without_dynamics(const LatentTraining& options) {
  Kernel absent = dynamics_kernel(options);
  absent.terms.push_back(WhiteTerm{});
  std::vector<std::string> fixed = options.fixed;
  for (const auto& parameter : parameter_names(absent)) std::erase(fixed, "dynamics." + parameter);
  return fixed;
}

/// Dynamics whose input is time.
GpStream stream_of_times(LatentTraining options, const SgpdmProblem& problem) {
  const Eigen::MatrixXd times = times_of(problem.lengths, problem.form);
  const Eigen::MatrixXd inducing = spread_times(times, options.dynamics_inverse_width, options.inducing);
  options.inducing = static_cast<int>(inducing.rows());
  GpStream stream =
      stream_of(options, "dynamics", dynamics_kernel(options), times, problem.lengths, problem.dynamics_weight);
  if (stream.inducing.rows() > 0) stream.inducing = inducing;
  return stream;
}

/// p(X), if any: dynamics and what first points have, or the same for every point.
void add_latent_prior(const LatentTraining& options, SgpdmProblem& problem) {
  const Lengths& lengths = problem.lengths;
  const auto frames = static_cast<std::size_t>(problem.latents.rows());
  const bool steps = frames > lengths.size();
  if (options.dynamics == LatentDynamics::none) {
    if (!options.latent_prior) return;
    problem.lengths.assign(frames, 1);
    problem.first_variance = 1;
  } else if (steps && is_timed(problem.form)) {
    problem.dynamics = stream_of_times(options, problem);
  } else {
    if (!steps || options.first_point == FirstPoint::variance) problem.first_variance = options.first_variance;
    if (!steps) return;
    problem.dynamics = stream_of(options, "dynamics", dynamics_kernel(options), steps_of(problem.latents, lengths).from,
                                 lengths_of_steps(lengths), problem.dynamics_weight);
  }
}

SgpdmProblem problem_of(const LatentTraining& options, const std::vector<TrainingStream>& streams,
                        const std::vector<ScaledFrames>& frames, const Lengths& lengths, const Eigen::MatrixXd& start) {
  SgpdmProblem problem;
  problem.lengths = lengths;
  problem.latents = start;
  problem.back_constraint = back_projection(options, frames[0].scaled(), start);
  if (problem.back_constraint)
    problem.latents = problem.back_constraint->compute(problem.back_constraint->parameters());
  problem.form = form_of(options.dynamics);
  problem.prior_deviation = options.prior_deviation;

  Eigen::Index larger = 0;
  Kernel observation{{RbfTerm{1, 1}, BiasTerm{0.1}}};
  if (options.kernel == ObservationKernel::ard) observation.terms[0] = ArdTerm{1, Eigen::VectorXd::Ones(start.cols())};
  for (std::size_t i = 0; i < streams.size(); ++i) {
    larger = std::max(larger, frames[i].values.cols());
    problem.observations.push_back(
        {stream_of(options, streams[i].name, observation, problem.latents, lengths, streams[i].weight),
         frames[i].values, frames[i].scale, options.learn_scale});
  }
  problem.dynamics_weight = options.dynamics_bias ? static_cast<double>(larger) / static_cast<double>(start.cols()) : 1;
  add_latent_prior(options, problem);
  problem.fixed = problem.dynamics ? options.fixed : fixed_without_dynamics(options);
  return problem;
}

}  // namespace

Eigen::RowVectorXd output_scale(const Eigen::RowVectorXd& deviation, OutputScaling scaling) {
  Eigen::RowVectorXd ones = Eigen::RowVectorXd::Ones(deviation.size());
  if (scaling == OutputScaling::none || (deviation.array() == 0).all()) return ones;
  if (scaling == OutputScaling::per_dimension) return (deviation.array() > 0).select(deviation, ones);
  return deviation.stableNorm() / std::sqrt(static_cast<double>(deviation.size())) * ones;
}

std::string nothing_varies(const std::string& subject, Eigen::Index frames) {
  return fmt::format("{}: nothing varies in {} frames: the model answers with their mean", subject, frames);
}

std::unique_ptr<GpLikelihood> make_likelihood(CovarianceApproximation approximation, const Lengths& lengths,
                                              Eigen::Index most) {
  switch (approximation) {
    case CovarianceApproximation::full:
      return std::make_unique<FullLikelihood>();
    case CovarianceApproximation::dtc:
      return std::make_unique<DtcLikelihood>();
    case CovarianceApproximation::fitc:
      return std::make_unique<FitcLikelihood>();
    case CovarianceApproximation::pitc:
      return std::make_unique<PitcLikelihood>(blocks_within(lengths, most));
    case CovarianceApproximation::variational:
      return std::make_unique<VariationalLikelihood>();
  }
  throw std::logic_error("no such approximation");
}

Eigen::MatrixXd spread(const Eigen::MatrixXd& x, Eigen::Index count) {
  Eigen::MatrixXd chosen(count, x.cols());
  for (Eigen::Index i = 0; i < count; ++i) chosen.row(i) = x.row(i * x.rows() / count);
  return chosen;
}

ApproximateGp approximate_gp(CovarianceApproximation approximation, const Eigen::MatrixXd& x, const Lengths& lengths,
                             Eigen::Index inducing) {
  if (approximation == CovarianceApproximation::full || x.rows() <= inducing)
    return {std::make_unique<FullLikelihood>(), Eigen::MatrixXd(0, x.cols())};
  return {make_likelihood(approximation, lengths, inducing), spread(x, inducing)};
}

TrainedLatents train_latents(const LatentTraining& options, const std::string& subject,
                             const std::vector<TrainingStream>& streams, const Lengths& lengths,
                             const StartValues& start, Context& context) try {
  std::vector<ScaledFrames> frames;
  std::vector<Eigen::MatrixXd> scaled;
  for (const auto& s : streams) {
    frames.emplace_back(s);
    scaled.push_back(frames.back().scaled());
  }
  const Eigen::Index d = allowed_dimension(options.latent_dimension, subject, streams, context);
  SgpdmProblem problem = problem_of(options, streams, frames, lengths, start(scaled, d));
  TrainedLatents trained;
  trained.form = problem.form;
  trained.dynamics_weight = problem.dynamics_weight;
  SgpdmObjective objective(std::move(problem));

  const bool varies = std::any_of(frames.begin(), frames.end(), [](const auto& f) { return f.varies(); });
  if (!varies) context.warn(nothing_varies(subject, streams[0].frames.rows()));
  Maximisation how = options;
  if (!varies) how.iterations = 0;
  OptimiserState reached = how.maximise(subject, objective, objective.start(), context);
  Eigen::VectorXd parameters = std::move(reached.parameters);
  const bool constrained = options.back_constraint != BackConstraintKind::none;
  if (!constrained) parameters = rounded(parameters, 20);

  trained.latents = objective.latents(parameters);
  for (std::size_t i = 0; i < streams.size(); ++i) {
    trained.processes.push_back(compacted(objective.process(i, parameters), trained.latents));
    trained.processes.back().mean = frames[i].mean;
  }
  trained.first_frames = frames[0].values.array().rowwise() / trained.processes[0].scale.array();
  if (!constrained) trained.first_frames = rounded(trained.first_frames, 12);
  trained.dynamics = objective.dynamics(parameters);
  if (trained.dynamics) {
    const bool timed = is_timed(trained.form);
    trained.dynamics =
        compacted(std::move(*trained.dynamics), timed ? times_of(lengths, trained.form) : trained.latents);
    trained.dynamics->mean = Eigen::RowVectorXd::Zero(d);
    trained.dynamics->scale = Eigen::RowVectorXd::Ones(d);
  }
  if (auto b = objective.back_constraint(parameters))
    trained.back_constraint = of_rescaled(std::move(*b), trained.processes[0].scale.array() / frames[0].scale.array());
  trained.first_variance = objective.first_variance(parameters);
  trained.jitter = objective.jitter();
  trained.report = std::move(reached.report);
  trained.ended = varies ? str(trained.report.reason) : "nothing varies";
  context.log(fmt::format("{}: {} frames in {} sequences, d = {}, ln p = {:.6g} after {} iterations ({}){}", subject,
                          trained.latents.rows(), lengths.size(), d, -trained.report.cost, trained.report.iterations,
                          trained.ended, trained.jitter > 1e-6 ? fmt::format(", jitter {:.1g}", trained.jitter) : ""));
  return trained;
} catch (const FactorisationError& e) {
  throw FactorisationError(subject + ": " + e.what());
}

}  // namespace talkgraph
