#include "nodes/latent/gp_regression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/latent/gp_objective.h"
#include "nodes/latent/predictive.h"
#include "nodes/types/centred.h"
#include "nodes/yardstick/stacked.h"

namespace talkgraph {

void parameters(Parameters<KernelChoice>& p) {
  p.param("kind", &KernelChoice::kind).required().doc("rbf, ard (rbf with a width a dimension), linear, bias, white");
  p.param("variance", &KernelChoice::variance).positive().doc("to start from");
  p.param("inverse_width", &KernelChoice::inverse_width).positive().doc("of rbf and ard, to start from");
  p.param("minimum", &KernelChoice::minimum).at_least(0).doc("of white: its variance stays above this");
}

Kernel kernel_of(const std::vector<KernelChoice>& terms, Eigen::Index d) {
  Kernel kernel;
  for (const KernelChoice& t : terms) switch (t.kind) {
      case KernelKind::rbf:
        kernel.terms.push_back(RbfTerm{t.variance, t.inverse_width});
        break;
      case KernelKind::ard:
        kernel.terms.push_back(ArdTerm{t.variance, Eigen::VectorXd::Constant(d, t.inverse_width)});
        break;
      case KernelKind::linear:
        kernel.terms.push_back(LinearTerm{t.variance});
        break;
      case KernelKind::bias:
        kernel.terms.push_back(BiasTerm{t.variance});
        break;
      case KernelKind::white:
        kernel.terms.push_back(WhiteTerm{std::max(t.variance, 2 * t.minimum), t.minimum});
        break;
    }
  return kernel;
}

GpRegression TrainGp::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                                 Context& context) const {
  if (std::all_of(kernel.begin(), kernel.end(), [](const auto& term) { return term.kind == KernelKind::white; }))
    throw std::runtime_error(
        "a kernel that ties no frames together: give it a term besides white, such as rbf, ard or linear");
  const StackedTraining training = stack_training(audio, visual, this->context);
  const double shrink = 1 / std::sqrt(static_cast<double>(training.audio.cols()));
  const Eigen::MatrixXd x = training.audio * shrink;
  const CentredFrames visual_frames = centred(training.visual);
  if (!visual_frames.varies())
    context.warn(
        fmt::format("no visual parameter varies in the {} training frames: all predictions are their mean", x.rows()));
  const Eigen::RowVectorXd scale = output_scale(visual_frames.deviation, OutputScaling::per_dimension);
  const Eigen::MatrixXd y = visual_frames.values.array().rowwise() / scale.array();

  const auto [likelihood, start] = approximate_gp(approximation, x, training.lengths, inducing);
  GpObjective objective(*likelihood, kernel_of(kernel, x.cols()), x, start, fix_inducing, y);
  const OptimiserState reached = maximise("Gaussian process", objective, objective.start(), context);
  const double log_scale = static_cast<double>(x.rows()) * scale.array().log().sum();

  GpRegression model;
  model.inputs = training.inputs;
  model.inputs.scale *= shrink;
  model.process = objective.posterior(reached.parameters);
  model.process.mean = visual_frames.mean;
  model.process.scale = scale;
  model.log_likelihood = -reached.report.cost - log_scale;
  model.iterations = reached.report.iterations;
  model.frames = x.rows();
  for (const double cost : reached.report.trace) model.trace.push_back(-cost - log_scale);
  model.ended = str(reached.report.reason);
  model.jitter = likelihood->jitter();
  context.log(fmt::format("{} frames of {} inputs, ln p = {:.6g} after {} iterations ({}){}", x.rows(), x.cols(),
                          model.log_likelihood, model.iterations, model.ended,
                          model.jitter > 0 ? fmt::format(", jitter {:.1g}", model.jitter) : ""));
  return model;
}

PredictGp::Prediction PredictGp::operator()(const GpRegression& model, const Track& audio) const {
  Predictive predictive;
  predictive.compute(model.process, stacked(model.inputs, audio));
  Prediction p;
  p.track.rate = p.deviation.rate = audio.rate;
  p.track.start = p.deviation.start = audio.start;
  p.track.lost = p.deviation.lost = audio.lost;
  p.track.values = unscaled(model.process, predictive.mean());
  p.deviation.values = predictive.variance().cwiseSqrt() * model.process.scale;
  return p;
}

void describe(Description<TrainGp>& d) {
  d.type("latent.gp").version(3).summary("learns Gaussian process regression from sound to visual parameters").stored();
  d.source("Thesis §4.2.5, Eqns 4.20-4.33");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "a process of visual parameters");
  d.param("context", &TrainGp::context).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("kernel", &TrainGp::kernel).doc("terms of a sum; white is the noise");
  d.param("approximation", &TrainGp::approximation)
      .doc(
          "of the covariance of more frames than inducing points; blocks of pitc have as many frames as there are "
          "inducing points, at most");
  d.param("inducing", &TrainGp::inducing).at_least(1).doc("inducing points");
  d.param("fix_inducing", &TrainGp::fix_inducing).doc("inducing points stay the frames they start from");
  describe_maximisation(d);
}

void describe(Description<PredictGp>& d) {
  d.type("latent.gp_predict")
      .version(2)
      .summary("predicts visual parameters and their deviation by a Gaussian process");
  d.source("Thesis §4.2.5, Eqns 4.30, 4.31; the variance includes the noise");
  d.input("model", "of latent.gp").input("audio", "speech features at the video rate");
  d.output("track", &PredictGp::Prediction::track, "visual parameters")
      .output("deviation", &PredictGp::Prediction::deviation, "standard deviation of each");
}

}  // namespace talkgraph
