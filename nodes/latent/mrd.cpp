#include "nodes/latent/mrd.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "nodes/latent/bayesian_objective.h"
#include "nodes/latent/checkpoint.h"
#include "nodes/latent/latent_dynamics.h"
#include "nodes/latent/linear_models.h"
#include "nodes/latent/stochastic_training.h"

namespace talkgraph {

namespace {

struct Frames {
  ObservedOutputs audio, visual;
  std::vector<std::int64_t> lengths;
};

Frames frames_of(const StateData& data, OutputScaling audio_scaling, OutputScaling visual_scaling) {
  if (data.audio.size() != data.visual.size())
    throw std::runtime_error(fmt::format("{} audio windows but {} visual", data.audio.size(), data.visual.size()));
  if (data.audio.empty()) throw std::runtime_error("no training windows; map it to a shorter label (context.windows)");
  Frames frames;
  for (std::size_t i = 0; i < data.audio.size(); ++i) {
    const auto &y = data.audio[i], &z = data.visual[i];
    if (y.rows() != z.rows() || y.rows() == 0 || y.cols() != data.audio[0].cols() || y.cols() == 0 ||
        z.cols() != data.visual[0].cols() || z.cols() == 0)
      throw std::runtime_error(fmt::format(
          "window {} is {} × {} of audio and {} × {} of visual features: both need as many frames, at least "
          "one, and the dimensions of window 0",
          i, y.rows(), y.cols(), z.rows(), z.cols()));
    frames.lengths.push_back(y.rows());
  }
  const auto stacked = [&](const std::vector<Eigen::MatrixXd>& windows) {
    Eigen::MatrixXd all(std::accumulate(frames.lengths.begin(), frames.lengths.end(), std::int64_t{0}),
                        windows[0].cols());
    Eigen::Index row = 0;
    for (const auto& w : windows) {
      all.middleRows(row, w.rows()) = w;
      row += w.rows();
    }
    return all;
  };
  frames.audio = observed_outputs(stacked(data.audio), audio_scaling, "audio");
  frames.visual = observed_outputs(stacked(data.visual), visual_scaling, "visual");
  return frames;
}

/// Principal components of both streams side by side, each of the same weight; unit variance where they vary.
Eigen::MatrixXd start_latents(const Frames& f, Eigen::Index d) {
  Eigen::MatrixXd both(f.audio.rows(), f.audio.outputs() + f.visual.outputs());
  both << f.audio.values / std::sqrt(static_cast<double>(f.audio.outputs())),
      f.visual.values / std::sqrt(static_cast<double>(f.visual.outputs()));
  Eigen::MatrixXd x = fit_ppca(both, d).posterior_mean(both);
  for (Eigen::Index q = 0; q < d; ++q) {
    const double deviation = std::sqrt(x.col(q).squaredNorm() / static_cast<double>(x.rows()));
    x.col(q) *= deviation > 1e-6 ? 1 / deviation : 0;
  }
  return x;
}

/// Inverse widths of 1 for the latent dimension that explains most of a stream by itself, for others by their share.
Eigen::VectorXd start_widths(const ObservedOutputs& y, const Eigen::MatrixXd& x) {
  const Eigen::VectorXd explained = (x.transpose() * y.values).rowwise().squaredNorm();
  return (explained / std::max(explained.maxCoeff(), 1e-300)).cwiseMax(0.05);
}

struct Relevance {
  std::vector<Eigen::Index> found;  ///< dimensions relevant to a stream, most relevant first
  Eigen::VectorXd audio, visual;    ///< of those
  std::vector<Eigen::Index> kept;   ///< that the model has
  int shared = 0, audio_only = 0, visual_only = 0;
};

Eigen::VectorXd relevance_to(const VariationalStream& stream, const Eigen::MatrixXd& mean) {
  const Eigen::MatrixXd centred = mean.rowwise() - mean.colwise().mean();
  const Eigen::VectorXd r = stream.process().kernel.inverse_widths.cwiseProduct(
      centred.colwise().squaredNorm().transpose() / static_cast<double>(mean.rows()));
  if (!stream.outputs().varies) return Eigen::VectorXd::Zero(r.size());
  return r / std::max(r.maxCoeff(), 1e-300);
}

Relevance relevance_of(const VariationalStream& audio, const VariationalStream& visual, const Eigen::MatrixXd& mean,
                       double least, bool with_visual_only) {
  const Eigen::VectorXd a = relevance_to(audio, mean), v = relevance_to(visual, mean), sum = a + v;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(sum.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return sum[i] > sum[j]; });
  Relevance r;
  for (const auto q : order) {
    const bool heard = a[q] >= least, seen = v[q] >= least;
    r.shared += heard && seen;
    r.audio_only += heard && !seen;
    r.visual_only += !heard && seen;
    if (heard || seen) r.found.push_back(q);
    if (heard || (seen && with_visual_only)) r.kept.push_back(q);
  }
  if (r.kept.empty()) r.kept.push_back(order[0]);
  r.audio = a(r.found);
  r.visual = v(r.found);
  return r;
}

/// The process as a function of the dimensions kept, its mean and variance over others ~ N(0, 1).
GaussianProcess averaged(GaussianProcess gp, const ArdKernel& kernel, const std::vector<Eigen::Index>& kept) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index q = 0; q < gp.basis.cols(); ++q)
    if (std::find(kept.begin(), kept.end(), q) == kept.end()) others.push_back(q);
  const auto count = static_cast<Eigen::Index>(others.size());
  PsiStatistics psi;
  psi.begin({1, 0, kernel.inverse_widths(others)}, gp.basis(Eigen::all, others));
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(1, count), one = Eigen::MatrixXd::Ones(1, count);
  const Eigen::VectorXd factors = psi.first(zero, one).transpose();
  Eigen::MatrixXd pairs = Eigen::MatrixXd::Zero(factors.size(), factors.size());
  psi.add_second(zero, one, pairs);

  const Eigen::MatrixXd spread = gp.weights * gp.weights.transpose() / static_cast<double>(gp.weights.cols());
  gp.reduction = gp.reduction.cwiseProduct(pairs) - spread.cwiseProduct(pairs - factors * factors.transpose());
  gp.mean.array() += gp.scale.array() * (kernel.bias * (1 - factors.array()).matrix().transpose() * gp.weights).array();
  gp.weights = factors.asDiagonal() * gp.weights;
  gp.basis = gp.basis(Eigen::all, kept).eval();
  return gp;
}

GaussianProcess process_of(VariationalStream& stream, const GaussianRows& q, const std::vector<Eigen::Index>& kept) {
  const VariationalProcess& p = stream.process();
  GaussianProcess gp = averaged(stream.posterior(q), p.kernel, kept);
  gp.kernel.terms = {ArdTerm{p.kernel.variance, p.kernel.inverse_widths(kept)}, BiasTerm{p.kernel.bias},
                     WhiteTerm{p.noise, p.minimum_noise}};
  return gp;
}

Table relevance_table(const std::string& label, const Relevance& r, double least) {
  Table table{
      fmt::format("Relevance of latent dimensions of state \"{}\"", label), "dimension", {"audio", "visual"}, {}, {}};
  for (Eigen::Index i = 0; i < r.audio.size(); ++i) {
    const bool heard = r.audio[i] >= least, seen = r.visual[i] >= least;
    table.rows.push_back(fmt::format("{} ({})", i + 1, heard && seen ? "shared" : heard ? "audio" : "visual"));
    table.cells.push_back({r.audio[i], r.visual[i]});
  }
  return table;
}

Table dimensions_table(const std::string& label, const Relevance& r, Eigen::Index frames, double bound) {
  const double n = static_cast<double>(frames);
  return {"Latent dimensions found",
          "state",
          {"frames", "shared", "audio only", "visual only", "bound a frame"},
          {label},
          {{n, static_cast<double>(r.shared), static_cast<double>(r.audio_only), static_cast<double>(r.visual_only),
            bound / n}}};
}

struct Trained {
  Eigen::VectorXd parameters;
  double bound = 0;
  int iterations = 0;
  std::string end;
  std::vector<double> trace;
};

StochasticTraining in_parts(const TrainMrd& node, std::uint64_t seed) {
  StochasticTraining training;
  training.seed = seed;
  training.batch = node.batch;
  training.epochs = node.epochs;
  training.noise_held = node.epochs * node.hold_noise / std::max(1, node.iterations);
  if (node.time_limit > 0) training.seconds = node.time_limit;
  return training;
}

Trained train_whole(const TrainMrd& node, const std::string& subject, BayesianObjective& objective, Context& context) {
  OptimiserState reached = node.maximise(subject, objective, objective.start(), context);
  Trained trained{std::move(reached.parameters), 0, reached.report.iterations, str(reached.report.reason), {}};
  trained.bound = objective.value(trained.parameters, nullptr);
  for (const double cost : reached.report.trace) trained.trace.push_back(-cost);
  return trained;
}

/// Of all that training in parts depends on.
Key key_of(StochasticTraining training, const std::string& subject, BayesianObjective& objective) {
  std::string what = subject;
  Eigen::VectorXd start = objective.start();
  double bound = objective.value(start, nullptr);
  return content_key([&](Archive& ar) {
    ar("subject", what);
    ar("start", start);
    ar("bound", bound);
    ar("batch", training.batch);
    ar("epochs", training.epochs);
    ar("noise_held", training.noise_held);
    ar("seconds", training.seconds);
    ar("seed", training.seed);
  });
}

Trained train_in_parts(const TrainMrd& node, const std::string& subject, BayesianObjective& objective, Context& context,
                       Random& random) {
  StochasticTraining training = in_parts(node, random.bits());
  StochasticTraining::State state;
  Checkpoint saved(
      node.checkpoint, [&] { return key_of(training, subject, objective); },
      [&](Archive& ar) {
        ar("state", state);
        for (auto& stream : objective.streams()) ar(stream.name(), stream.inducing_posterior());
      });
  if (!saved.load(subject, context)) {
    state = {};
    for (auto& stream : objective.streams()) stream.inducing_posterior() = {};
  }
  training.on_part = [&](double share) {
    saved.between_steps(context);
    context.progress(share);
  };
  training(objective, state);
  saved.remove();
  const double bound = *std::max_element(state.trace.begin(), state.trace.end());
  const auto taken = static_cast<int>(state.trace.size()) - 1;
  return {std::move(state.best), bound, taken, state.ended, std::move(state.trace)};
}

Trained untrained(BayesianObjective& objective) {
  return {objective.start(), objective.value(objective.start(), nullptr), 0, "nothing varies", {}};
}

BayesianObjective objective_of(const TrainMrd& node, const Frames& frames) {
  const Eigen::Index n = frames.audio.rows(), outputs = frames.audio.outputs() + frames.visual.outputs();
  const Eigen::Index d = std::max<Eigen::Index>(1, std::min<Eigen::Index>({node.latent_dimension, outputs, n - 1}));
  const Eigen::MatrixXd x = start_latents(frames, d);
  std::vector<VariationalStream> streams;
  for (const auto* y : {&frames.audio, &frames.visual}) {
    VariationalProcess process;
    process.kernel.inverse_widths = start_widths(*y, x);
    process.minimum_noise = node.minimum_noise;
    process.noise = std::max(node.noise, 2 * node.minimum_noise);
    process.inducing = spread(x, std::min<Eigen::Index>(node.inducing, n));
    streams.emplace_back(y == &frames.audio ? "audio" : "visual", *y, std::move(process));
  }
  return {LatentPosterior(frames.lengths, node.time_width), std::move(streams), x, 0.1};
}

}  // namespace

TrainMrd::Out TrainMrd::operator()(const StateData& data, Context& context, Random& random) const try {
  const Frames frames = frames_of(data, audio_scaling, visual_scaling);
  BayesianObjective objective = objective_of(*this, frames);
  const bool varies = frames.audio.varies || frames.visual.varies;
  const std::string subject = "state \"" + data.label + "\"";
  if (!varies) context.warn(nothing_varies(subject, objective.rows()));
  const Trained trained = !varies     ? untrained(objective)
                          : batch > 0 ? train_in_parts(*this, subject, objective, context, random)
                                      : train_whole(*this, subject, objective, context);
  const GaussianRows q = objective.posterior(trained.parameters);
  auto &audio = objective.streams()[0], &visual = objective.streams()[1];
  const Relevance r = relevance_of(audio, visual, q.mean, relevant, visual_only == VisualOnly::keep);
  const Eigen::Index n = objective.rows();

  Out out;
  out.model.label = data.label;
  out.model.latents = q.mean(Eigen::all, r.kept);
  out.model.lengths = frames.lengths;
  out.model.audio_frames = frames.audio.values;
  out.model.audio = process_of(audio, q, r.kept);
  out.model.visual = process_of(visual, q, r.kept);
  if (dynamics && n > static_cast<Eigen::Index>(frames.lengths.size()))
    out.model.dynamics = fit_dynamics(out.model.latents, frames.lengths, dynamics_inverse_width, inducing, 20);
  if (dynamics_bias)
    out.model.dynamics_bias = static_cast<double>(std::max(frames.audio.outputs(), frames.visual.outputs())) /
                              static_cast<double>(out.model.latents.cols());
  out.model.first_variance = first_variance;
  out.model.log_likelihood = trained.bound;
  out.model.iterations = trained.iterations;
  out.model.trace = trained.trace;
  out.model.ended = trained.end;
  out.model.jitter = objective.jitter();

  out.relevance = relevance_table(data.label, r, relevant);
  out.dimensions = dimensions_table(data.label, r, n, trained.bound);
  context.log(fmt::format(
      "state \"{}\": {} frames in {} windows, bound {:.6g} after {} iterations ({}); of {} dimensions {} shared, {} of "
      "audio, {} of visual only; relevance to audio {:.2f}, to visual {:.2f}",
      data.label, n, frames.lengths.size(), trained.bound, trained.iterations, trained.end, objective.dimension(),
      r.shared, r.audio_only, r.visual_only, fmt::join(r.audio, " "), fmt::join(r.visual, " ")));
  return out;
} catch (const Cancelled&) {
  throw;
} catch (const std::runtime_error& e) {
  throw std::runtime_error("state \"" + data.label + "\": " + e.what());
}

void describe(Description<TrainMrd>& d) {
  d.type("latent.mrd").version(5).stored();
  d.summary("trains a state's shared latent model, finding its dimension and what each stream needs of it");
  d.source("Titsias & Lawrence 2010; Damianou, Titsias & Lawrence 2011; Damianou, Ek, Titsias & Lawrence 2012");
  d.input("windows", "training windows of one state, NaN where a value is missing");
  d.output("model", &TrainMrd::Out::model, "audio and visual processes of one latent trajectory")
      .output("relevance", &TrainMrd::Out::relevance, "of each dimension found, to audio and visual stream")
      .output("dimensions", &TrainMrd::Out::dimensions, "how many are shared, of audio only, of visual only");
  d.param("latent_dimension", &TrainMrd::latent_dimension)
      .at_least(1)
      .doc("dimensions to choose from, lowered to those of both streams and to the number of frames less one");
  d.param("inducing", &TrainMrd::inducing).at_least(1).doc("inducing points of each process");
  describe_maximisation(d);
  d.param("batch", &TrainMrd::batch)
      .at_least(0)
      .doc("frames of a part in stochastic training, for thousands of frames; 0: all at once, by the optimiser");
  d.param("epochs", &TrainMrd::epochs)
      .at_least(0)
      .doc(
          "most passes of stochastic training over all frames; it ends when ten gain less than 0.01 a frame, and holds "
          "the noise in a share hold_noise / iterations of the most");
  d.param("time_width", &TrainMrd::time_width)
      .at_least(0)
      .doc("width in frames of a prior over time on each window's latent path; 0: none");
  d.param("audio_scaling", &TrainMrd::audio_scaling).doc("as visual_scaling, of the audio frames");
  d.param("visual_scaling", &TrainMrd::visual_scaling)
      .doc("per_dimension gives every dimension the same weight; common keeps the ratios of their variances");
  d.param("noise", &TrainMrd::noise).positive().doc("noise variance to start from, in scaled units");
  d.param("minimum_noise", &TrainMrd::minimum_noise).at_least(0).doc("noise variance stays above this");
  d.param("relevant", &TrainMrd::relevant)
      .within(0, 1)
      .doc("least relevance, as a share of the largest, of a dimension that a stream is said to need");
  d.param("visual_only", &TrainMrd::visual_only)
      .doc("dimensions of the visual stream only, which sound says nothing of: keep, or average over them");
  d.param("dynamics", &TrainMrd::dynamics).doc("off: none are learnt");
  d.param("dynamics_bias", &TrainMrd::dynamics_bias)
      .doc("the dynamics weigh larger dimension / latent dimension in synthesis");
  d.param("dynamics_inverse_width", &TrainMrd::dynamics_inverse_width)
      .positive()
      .doc("of the RBF part of the dynamics kernel");
  d.param("first_variance", &TrainMrd::first_variance)
      .positive()
      .doc("variance of the prior of a segment's first latent point in synthesis");
}

}  // namespace talkgraph
