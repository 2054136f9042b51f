#include "nodes/latent/sgpdm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/latent/linear_models.h"
#include "nodes/latent/predictive.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sgpdm_objective.h"

namespace talkgraph {

namespace {

struct Frames {
  Eigen::MatrixXd audio, visual;
  std::vector<std::int64_t> lengths;
};

void check(const StateData& data) {
  const auto fail = [&](const std::string& what) { throw std::runtime_error("state \"" + data.label + "\": " + what); };
  if (data.audio.size() != data.visual.size())
    fail(fmt::format("{} audio windows but {} visual", data.audio.size(), data.visual.size()));
  if (data.audio.empty()) fail("no training windows; map it to a shorter label (context.windows)");
  for (std::size_t i = 0; i < data.audio.size(); ++i) {
    const auto &y = data.audio[i], &z = data.visual[i];
    if (y.rows() != z.rows() || y.rows() == 0)
      fail(fmt::format("window {} has {} audio frames and {} visual", i, y.rows(), z.rows()));
    if (y.cols() != data.audio[0].cols() || z.cols() != data.visual[0].cols() || y.cols() == 0 || z.cols() == 0)
      fail(
          fmt::format("window {} has {} audio and {} visual dimensions, not those of window 0", i, y.cols(), z.cols()));
    if (!y.allFinite() || !z.allFinite()) fail(fmt::format("window {} has a value that is not finite", i));
  }
}

Frames stacked(const StateData& data) {
  Frames f;
  Eigen::Index n = 0;
  for (const auto& window : data.audio) n += window.rows();
  f.audio.resize(n, data.audio[0].cols());
  f.visual.resize(n, data.visual[0].cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < data.audio.size(); ++i) {
    f.audio.middleRows(row, data.audio[i].rows()) = data.audio[i];
    f.visual.middleRows(row, data.visual[i].rows()) = data.visual[i];
    f.lengths.push_back(data.audio[i].rows());
    row += data.audio[i].rows();
  }
  return f;
}

struct Scaled {
  Eigen::MatrixXd values;
  Eigen::RowVectorXd mean, scale;
  bool varies = false;
};

Scaled scaled_by(OutputScaling scaling, const Eigen::MatrixXd& y) {
  Scaled s;
  s.mean = y.colwise().mean();
  s.values = y.rowwise() - s.mean;
  const Eigen::RowVectorXd deviation = (s.values.colwise().squaredNorm() / static_cast<double>(y.rows())).cwiseSqrt();
  const double common = std::sqrt(deviation.squaredNorm() / static_cast<double>(y.cols()));
  s.varies = common > 1e-12 * (1 + s.mean.cwiseAbs().maxCoeff());
  s.scale.setOnes(y.cols());
  if (s.varies && scaling == OutputScaling::common) s.scale.setConstant(common);
  if (s.varies && scaling == OutputScaling::per_dimension)
    for (Eigen::Index c = 0; c < y.cols(); ++c)
      if (deviation[c] > 1e-6 * common) s.scale[c] = deviation[c];
  s.values.array().rowwise() /= s.scale.array();
  return s;
}

Eigen::MatrixXd averaged_ppca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d) {
  const Eigen::MatrixXd a = fit_ppca(y, d).posterior_mean(y);
  Eigen::MatrixXd b = fit_ppca(z, d).posterior_mean(z);
  for (Eigen::Index c = 0; c < d; ++c)
    if (a.col(c).dot(b.col(c)) < 0) b.col(c) = -b.col(c);
  return 0.5 * (a + b);
}

std::unique_ptr<GpLikelihood> likelihood_for(bool sparse) {
  if (sparse) return std::make_unique<FitcLikelihood>();
  return std::make_unique<FullLikelihood>();
}

/// Rows at even distances.
Eigen::MatrixXd spread(const Eigen::MatrixXd& x, Eigen::Index count) {
  Eigen::MatrixXd chosen(count, x.cols());
  for (Eigen::Index i = 0; i < count; ++i) chosen.row(i) = x.row(i * x.rows() / count);
  return chosen;
}

Eigen::MatrixXd inputs_of_steps(const Eigen::MatrixXd& x, const std::vector<std::int64_t>& lengths) {
  Eigen::MatrixXd in(x.rows() - static_cast<Eigen::Index>(lengths.size()), x.cols());
  Eigen::Index from = 0, to = 0;
  for (const auto length : lengths) {
    in.middleRows(to, length - 1) = x.middleRows(from, length - 1);
    from += length;
    to += length - 1;
  }
  return in;
}

}  // namespace

Sgpdm TrainSgpdm::operator()(const StateData& data, Context& context) const {
  check(data);
  Frames frames = stacked(data);
  const Scaled audio = scaled_by(audio_scaling, frames.audio), visual = scaled_by(visual_scaling, frames.visual);
  const Eigen::Index n = audio.values.rows(), dy = audio.values.cols(), dz = visual.values.cols();
  const Eigen::Index d = std::max<Eigen::Index>(1, std::min<Eigen::Index>({latent_dimension, dy, dz, n - 1}));
  const double larger = static_cast<double>(std::max(dy, dz)), smaller = static_cast<double>(std::min(dy, dz));

  SgpdmProblem problem;
  problem.audio = audio.values;
  problem.visual = visual.values;
  problem.lengths = frames.lengths;
  problem.latents = initial == LatentStart::pcca
                        ? fit_pcca(audio.values, visual.values, d).posterior_mean(audio.values, visual.values)
                        : averaged_ppca(audio.values, visual.values, d);
  problem.dynamics_weight = dynamics_bias ? larger / static_cast<double>(d) : 1;
  problem.first_variance = first_variance;
  problem.prior_deviation = prior_deviation;
  problem.fixed = fixed;

  const double start_noise = std::max(noise, 2 * minimum_noise);
  const auto stream = [&](std::string name, Kernel kernel, const Eigen::MatrixXd& inputs, double weight) {
    const bool sparse = approximation == CovarianceApproximation::fitc && inputs.rows() > inducing;
    kernel.terms.push_back(WhiteTerm{start_noise, minimum_noise});
    return GpStream{std::move(name), std::move(kernel), spread(inputs, sparse ? inducing : 0), likelihood_for(sparse),
                    weight};
  };
  const Kernel observation{{RbfTerm{1, 1}, BiasTerm{0.1}}};
  const double bias = likelihood_bias ? larger / smaller : 1;
  problem.f = stream("audio", observation, problem.latents, dy < dz ? bias : 1);
  problem.g = stream("visual", observation, problem.latents, dz < dy ? bias : 1);
  problem.log_scale = static_cast<double>(n) * (problem.f.weight * audio.scale.array().log().sum() +
                                                problem.g.weight * visual.scale.array().log().sum());
  const bool steps = n > static_cast<Eigen::Index>(frames.lengths.size());
  if (dynamics && steps)
    problem.h = stream("dynamics", Kernel{{RbfTerm{0.1, dynamics_inverse_width}, LinearTerm{1}}},
                       inputs_of_steps(problem.latents, frames.lengths), problem.dynamics_weight);

  Sgpdm model;
  model.label = data.label;
  model.lengths = frames.lengths;
  model.audio_frames = audio.values;
  model.dynamics_bias = problem.dynamics_weight;
  model.first_variance = first_variance;

  SgpdmObjective objective(std::move(problem));
  Eigen::VectorXd parameters = objective.start();
  ScaledConjugateGradients optimiser;
  optimiser.iterations = audio.varies || visual.varies ? iterations : 0;
  optimiser.on_iteration = [&](int i, double) {
    context.check_cancelled();
    context.progress(static_cast<double>(i) / iterations);
  };
  const OptimiserReport report = optimiser.minimise(objective, parameters);
  if (report.reason == StopReason::failed) objective.log_likelihood(parameters, nullptr);

  model.latents = objective.latents(parameters);
  model.audio = objective.audio(parameters);
  model.audio.mean = audio.mean;
  model.audio.scale = audio.scale;
  model.visual = objective.visual(parameters);
  model.visual.mean = visual.mean;
  model.visual.scale = visual.scale;
  model.dynamics = objective.dynamics(parameters);
  if (model.dynamics) {
    model.dynamics->mean = Eigen::RowVectorXd::Zero(d);
    model.dynamics->scale = Eigen::RowVectorXd::Ones(d);
  }
  model.log_likelihood = -report.cost;
  model.iterations = report.iterations;
  model.jitter = objective.jitter();
  context.log(fmt::format("state \"{}\": {} frames in {} windows, d = {}, ln p = {:.1f} after {} iterations ({}){}",
                          data.label, n, frames.lengths.size(), d, -report.cost, report.iterations, str(report.reason),
                          model.jitter > 1e-6 ? fmt::format(", jitter {:.1g}", model.jitter) : ""));
  return model;
}

void describe(Description<TrainSgpdm>& d) {
  d.type("latent.sgpdm").version(1).stored();
  d.summary("trains the shared Gaussian process dynamical model of one state's audio and visual windows");
  d.source("Thesis §4.3.3-4.3.4, §5.1.2, Eqns 4.65-4.70, corrected as in docs/method.md §4");
  d.input("windows", "training windows of one state")
      .output("model", "audio and visual processes of one latent trajectory");
  d.param("latent_dimension", &TrainSgpdm::latent_dimension)
      .at_least(1)
      .doc("lowered to the smaller stream's dimension and to the number of frames less one");
  d.param("approximation", &TrainSgpdm::approximation).doc("of covariances of more frames than inducing points");
  d.param("inducing", &TrainSgpdm::inducing).at_least(1).doc("inducing points of each process");
  d.param("iterations", &TrainSgpdm::iterations).at_least(0).doc("limit of scaled conjugate gradients");
  d.param("initial", &TrainSgpdm::initial).doc("start values of the latent points");
  d.param("audio_scaling", &TrainSgpdm::audio_scaling).doc("as visual_scaling, of the audio frames");
  d.param("visual_scaling", &TrainSgpdm::visual_scaling)
      .doc("per_dimension gives every dimension the same weight; common keeps the ratios of their variances");
  d.param("dynamics", &TrainSgpdm::dynamics).doc("off: an SGPLVM");
  d.param("likelihood_bias", &TrainSgpdm::likelihood_bias)
      .doc("the stream of fewer dimensions weighs larger / smaller dimension");
  d.param("dynamics_bias", &TrainSgpdm::dynamics_bias)
      .doc("the dynamics weigh larger dimension / latent dimension, in synthesis too");
  d.param("first_variance", &TrainSgpdm::first_variance)
      .positive()
      .doc("variance of the prior of each window's first latent point");
  d.param("dynamics_inverse_width", &TrainSgpdm::dynamics_inverse_width)
      .positive()
      .doc("of the RBF part of the dynamics kernel");
  d.param("noise", &TrainSgpdm::noise).positive().doc("noise variance to start from, in scaled units");
  d.param("minimum_noise", &TrainSgpdm::minimum_noise).at_least(0).doc("noise variance stays above this");
  d.param("prior_deviation", &TrainSgpdm::prior_deviation)
      .at_least(0)
      .doc("standard deviation of a normal prior on log kernel parameters about their start values; 0: none");
  d.param("fixed", &TrainSgpdm::fixed)
      .doc("what is not optimised: latents, inducing, or <audio|visual|dynamics>.<parameter>");
}

}  // namespace talkgraph
