#include "nodes/latent/lds.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "nodes/latent/em.h"
#include "nodes/latent/lds_expectations.h"
#include "nodes/latent/linear_models.h"

namespace talkgraph {

namespace {

using Root = Eigen::LLT<Eigen::MatrixXd>;

[[noreturn]] void refuse(const char* what, Eigen::Index dims) {
  throw std::runtime_error(fmt::format(
      "linear dynamical system: the covariance of {}, of {} dimensions, is not positive definite: raise the "
      "floors of training",
      what, dims));
}

Root root_of(const Eigen::MatrixXd& covariance, const char* what) {
  Root root(covariance);
  if (root.info() != Eigen::Success) refuse(what, covariance.rows());
  return root;
}

/// B of a system, and frames that it gives, in units of the observation noise.
struct Whitened {
  explicit Whitened(const Lds& of) : model(of), observation(of.observation) {
    if (model.observation_noise.cols() == 1) {
      if (!(model.observation_noise.array() > 0).all()) refuse("the observations' noise", model.dimension());
      deviations = model.observation_noise.cwiseSqrt();
      log_determinant = 2 * deviations.array().log().sum();
    } else {
      root = root_of(model.observation_noise, "the observations' noise");
      log_determinant = 2 * root.matrixLLT().diagonal().array().log().sum();
    }
    whiten(observation);
    precision = observation.transpose() * observation;
  }
  void whiten(Eigen::MatrixXd& columns) const {
    if (deviations.size() > 0)
      columns = deviations.cwiseInverse().asDiagonal() * columns;
    else
      root.matrixL().solveInPlace(columns);
  }
  Eigen::MatrixXd columns(const Eigen::MatrixXd& frames) const {
    Eigen::MatrixXd columns = (frames.rowwise() - model.mean).transpose();
    whiten(columns);
    return columns;
  }

  const Lds& model;
  Eigen::VectorXd deviations;   ///< of diagonal noise
  Root root;                    ///< of other noise
  Eigen::MatrixXd observation;  ///< D × d
  Eigen::MatrixXd precision;    ///< BᵀΓ⁻¹B
  double log_determinant = 0;   ///< ln|Γ|
};

/// The systems of a sequence, and its frames, each in units of the noise of the one that gives it.
struct WhitenedFrames {
  WhitenedFrames(const LdsRegimes& regimes, const Eigen::MatrixXd& frames) : columns(frames.cols(), frames.rows()) {
    std::map<const Lds*, std::vector<Eigen::Index>> times;
    for (std::size_t t = 0; t < regimes.size(); ++t) times[regimes[t]].push_back(static_cast<Eigen::Index>(t));
    for (const auto& [model, of_model] : times) {
      const auto white = systems.emplace(model, *model).first;
      columns(Eigen::all, of_model) = white->second.columns(frames(of_model, Eigen::all));
    }
    for (const Lds* model : regimes) given_by.push_back(&systems.at(model));
  }
  std::map<const Lds*, Whitened> systems;
  std::vector<const Whitened*> given_by;  ///< T
  Eigen::MatrixXd columns;                ///< D × T
};

/// What a filter knows of a frame's state whatever the frames are.
struct FilterStep {
  Root predicted;              ///< of the covariance given the frames before
  Eigen::MatrixXd root;        ///< its lower triangle L; of an observed frame
  std::optional<Root> inner;   ///< of I + Lᵀ BᵀΓ⁻¹B L; of an observed frame
  Eigen::MatrixXd covariance;  ///< given this frame too
};

/// `before` is the covariance of the state before, null for the first.
FilterStep filter_step(const Whitened& white, const Eigen::MatrixXd* before, bool observed) {
  const Lds& model = white.model;
  FilterStep step;
  step.predicted = before ? root_of(model.prediction * *before * model.prediction.transpose() + model.prediction_noise,
                                    "a predicted state")
                          : root_of(model.first_covariance, "the first state");
  if (!observed) {
    step.covariance = step.predicted.reconstructedMatrix();
    return step;
  }
  step.root = step.predicted.matrixL();
  Eigen::MatrixXd inner = step.root.transpose() * white.precision * step.root;
  inner.diagonal().array() += 1;
  step.inner = root_of(inner, "an observed state");
  const Eigen::MatrixXd half = step.inner->matrixL().solve(step.root.transpose());
  step.covariance = half.transpose() * half;
  return step;
}

std::vector<FilterStep> filter_steps(const std::vector<const Whitened*>& given_by,
                                     const std::vector<std::int64_t>& lost) {
  std::vector<FilterStep> steps;
  for (std::size_t t = 0; t < given_by.size(); ++t)
    steps.push_back(filter_step(*given_by[t], t ? &steps.back().covariance : nullptr,
                                !std::binary_search(lost.begin(), lost.end(), static_cast<std::int64_t>(t))));
  return steps;
}

struct Filtered {
  Eigen::MatrixXd means, predicted;  ///< T × d: of the states, given frames up to theirs, and up to the one before
  double log_likelihood = 0;
};

Eigen::VectorXd predicted_mean(const Lds& model, const Eigen::VectorXd& before) {
  return model.prediction * before + model.offset;
}

/// Moves the mean of a predicted state to that given its frame, in units of the noise; log-likelihood of the frame.
double observe(const Whitened& white, const FilterStep& step, const Eigen::VectorXd& frame, Eigen::VectorXd& mean) {
  Eigen::VectorXd error = frame - white.observation * mean;
  const Eigen::VectorXd correction = step.inner->solve(step.root.transpose() * (white.observation.transpose() * error));
  mean += step.root * correction;
  error -= white.observation * (step.root * correction);
  const double constant = static_cast<double>(frame.size()) * std::log(2 * std::numbers::pi);
  return -0.5 * (white.log_determinant + constant + 2 * step.inner->matrixLLT().diagonal().array().log().sum() +
                 error.squaredNorm() + correction.squaredNorm());
}

Filtered filtered(const WhitenedFrames& frames, const std::vector<FilterStep>& steps) {
  const Eigen::Index d = frames.given_by.front()->model.states();
  Filtered f{Eigen::MatrixXd(frames.columns.cols(), d), Eigen::MatrixXd(frames.columns.cols(), d)};
  for (Eigen::Index t = 0; t < frames.columns.cols(); ++t) {
    const Whitened& white = *frames.given_by[static_cast<std::size_t>(t)];
    const FilterStep& step = steps[static_cast<std::size_t>(t)];
    Eigen::VectorXd mean =
        t == 0 ? white.model.first_mean : predicted_mean(white.model, f.means.row(t - 1).transpose());
    f.predicted.row(t) = mean.transpose();
    if (step.root.size() > 0) f.log_likelihood += observe(white, step, frames.columns.col(t), mean);
    f.means.row(t) = mean.transpose();
  }
  return f;
}

/// What a smoother knows whatever the frames are; one of T steps is for sequences of T frames.
struct SmootherSteps {
  std::vector<Eigen::MatrixXd> gains;        ///< T − 1: of x_t's mean by what x_{t+1}'s prediction missed
  std::vector<Eigen::MatrixXd> covariances;  ///< T
  std::vector<Eigen::MatrixXd> lagged;       ///< T − 1
};

SmootherSteps smoother_steps(const std::vector<const Whitened*>& given_by, const std::vector<FilterStep>& steps) {
  const std::size_t last = given_by.size() - 1;
  SmootherSteps s{std::vector<Eigen::MatrixXd>(last), {}, std::vector<Eigen::MatrixXd>(last)};
  for (std::size_t t = 0; t <= last; ++t) s.covariances.push_back(steps[t].covariance);
  for (std::size_t t = last; t-- > 0;) {
    const Lds& model = given_by[t + 1]->model;
    Eigen::MatrixXd& covariance = s.covariances[t];
    const Eigen::MatrixXd gain = steps[t + 1].predicted.solve(model.prediction * covariance).transpose();
    const Eigen::MatrixXd& after = s.covariances[t + 1];
    s.lagged[t] = after * gain.transpose();
    const Eigen::MatrixXd kept = Eigen::MatrixXd::Identity(gain.rows(), gain.rows()) - gain * model.prediction;
    covariance = kept * covariance * kept.transpose() + gain * (model.prediction_noise + after) * gain.transpose();
    s.gains[t] = gain;
  }
  return s;
}

LdsPosterior smoothed(Filtered f, const SmootherSteps& steps) {
  for (Eigen::Index t = f.means.rows() - 1; t-- > 0;)
    f.means.row(t) += (steps.gains[static_cast<std::size_t>(t)] *
                       (f.means.row(t + 1).transpose() - f.predicted.row(t + 1).transpose()))
                          .transpose();
  return {std::move(f.means), steps.covariances, steps.lagged, f.log_likelihood};
}

/// Each frame beside those before it, the first standing for what is before a sequence.
Eigen::MatrixXd stacked(const Sequences& data, Eigen::Index lags) {
  const Eigen::Index dims = data.frames.cols();
  Eigen::MatrixXd rows(data.frames.rows(), dims * lags);
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    for (Eigen::Index t = 0; t < length; ++t)
      for (Eigen::Index lag = 0; lag < lags; ++lag)
        rows.block(from + t, lag * dims, 1, dims) = data.frames.row(from + std::max<Eigen::Index>(t - lag, 0));
    from += length;
  }
  return rows;
}

Lds start_lds(const Sequences& data, const TrainLds& options, const LdsConstraints& constraints) {
  const Eigen::Index d = options.latent_dimension, dims = data.frames.cols();
  const Eigen::MatrixXd rows = stacked(data, std::max<Eigen::Index>(2, (d + dims - 1) / dims));
  const Ppca ppca = fit_ppca(rows, d);
  const Eigen::MatrixXd x = ppca.posterior_mean(rows), covariance = ppca.posterior_covariance();
  LdsExpectations e(d);
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    const auto steps = static_cast<std::size_t>(length);
    e.add({x.middleRows(from, length), std::vector(steps, covariance),
           std::vector(steps - 1, Eigen::MatrixXd(Eigen::MatrixXd::Zero(d, d))), 0});
    from += length;
  }
  Lds model;
  model.mean = data.frames.colwise().mean();
  model.prediction.setZero(d, d);
  model.offset.setZero(d);
  model.prediction_noise.setIdentity(d, d);
  maximise(model, data.frames, e, constraints);
  model.first_covariance.setIdentity(d, d);
  return model;
}

double expect(const Lds& model, const Sequences& data, LdsExpectations& e) {
  e = LdsExpectations(model.states());
  LdsSmoother smooth(model);
  double log_likelihood = 0;
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    const LdsPosterior p = smooth(data.frames.middleRows(from, length));
    e.add(p);
    log_likelihood += p.log_likelihood;
    from += length;
  }
  return log_likelihood;
}

}  // namespace

struct LdsSmoother::Steps {
  std::vector<FilterStep> filter;
  std::map<std::size_t, SmootherSteps> smoother;  ///< by the frames of a sequence
};

LdsSmoother::LdsSmoother(const Lds& model) : model_(model), steps_(std::make_unique<Steps>()) {}
LdsSmoother::~LdsSmoother() = default;

LdsPosterior LdsSmoother::operator()(const Eigen::MatrixXd& frames) {
  const WhitenedFrames whitened(LdsRegimes(static_cast<std::size_t>(frames.rows()), &model_), frames);
  const auto& given_by = whitened.given_by;
  auto& filter = steps_->filter;
  while (filter.size() < given_by.size())
    filter.push_back(filter_step(*given_by[0], filter.empty() ? nullptr : &filter.back().covariance, true));
  auto& of_length = steps_->smoother[given_by.size()];
  if (of_length.covariances.empty()) of_length = smoother_steps(given_by, filter);
  return smoothed(filtered(whitened, filter), of_length);
}

struct LdsFilter::System {
  explicit System(Lds of) : model(std::move(of)), white(model) {}
  Lds model;
  Whitened white;
};

LdsFilter::LdsFilter(Lds model) : system_(std::make_unique<System>(std::move(model))) {}
LdsFilter::LdsFilter(LdsFilter&&) noexcept = default;
LdsFilter::~LdsFilter() = default;

LdsBelief LdsFilter::operator()(const LdsBelief* before, const Eigen::RowVectorXd* frame) const {
  const Whitened& white = system_->white;
  const FilterStep step = filter_step(white, before ? &before->covariance : nullptr, frame != nullptr);
  LdsBelief belief{before ? predicted_mean(white.model, before->mean) : white.model.first_mean, step.covariance, 0};
  if (frame) belief.log_likelihood = observe(white, step, white.columns(*frame), belief.mean);
  return belief;
}

LdsPosterior kalman_filter(const LdsRegimes& regimes, const Eigen::MatrixXd& frames,
                           const std::vector<std::int64_t>& lost) {
  const WhitenedFrames whitened(regimes, frames);
  const auto steps = filter_steps(whitened.given_by, lost);
  Filtered f = filtered(whitened, steps);
  LdsPosterior p{std::move(f.means), {}, {}, f.log_likelihood};
  for (const auto& step : steps) p.covariances.push_back(step.covariance);
  return p;
}

LdsPosterior kalman_smoother(const LdsRegimes& regimes, const Eigen::MatrixXd& frames,
                             const std::vector<std::int64_t>& lost) {
  const WhitenedFrames whitened(regimes, frames);
  const auto steps = filter_steps(whitened.given_by, lost);
  return smoothed(filtered(whitened, steps), smoother_steps(whitened.given_by, steps));
}

LdsPosterior kalman_filter(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  return kalman_filter(LdsRegimes(static_cast<std::size_t>(frames.rows()), &model), frames, lost);
}

LdsPosterior kalman_smoother(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  return kalman_smoother(LdsRegimes(static_cast<std::size_t>(frames.rows()), &model), frames, lost);
}

Eigen::MatrixXd observations(const Lds& model, const Eigen::MatrixXd& states) {
  return (states * model.observation.transpose()).rowwise() + model.mean;
}

Lds observed_part(const Lds& model, Eigen::Index from, Eigen::Index dims) {
  Lds part = model;
  part.mean = model.mean.segment(from, dims);
  part.observation = model.observation.middleRows(from, dims);
  part.observation_noise = model.observation_noise.cols() == 1
                               ? Eigen::MatrixXd(model.observation_noise.middleRows(from, dims))
                               : Eigen::MatrixXd(model.observation_noise.block(from, from, dims, dims));
  return part;
}

Lds TrainLds::fit(const Sequences& data, Context& context, const LdsLimits& limits) const {
  const LdsConstraints constraints{Eigen::VectorXd::Constant(latent_dimension, state_floor),
                                   variance_floors(data.frames, floor), covariance, limits};
  Lds model = start_lds(data, *this, constraints);
  LdsExpectations given(model.states());
  model.trace = run_em(
      {iterations, tolerance}, data.frames.rows(), fmt::format("LDS of {} state dimensions", model.states()), context,
      [&] { return expect(model, data, given); }, [&] { maximise(model, data.frames, given, constraints); });
  return model;
}

Lds TrainLds::operator()(const Collected<Track>& tracks, Context& context) const {
  return fit(measured_runs(tracks), context);
}

void describe(Description<TrainLds>& d) {
  d.type("latent.lds").version(3).stored();
  d.summary("trains a linear dynamical system on tracks");
  d.source("Thesis §4.2.4, Eqns 4.13-4.19; expectation maximisation from PPCA");
  d.input("tracks", "every run of measured frames is a sequence").output("model", "the system's matrices");
  d.param("latent_dimension", &TrainLds::latent_dimension).at_least(1).doc("of the state");
  d.param("covariance", &TrainLds::covariance).doc("of the observations' noise");
  d.param("state_floor", &TrainLds::state_floor)
      .positive()
      .doc("least variance of first states and of the states' noise; states start with variance 1");
  describe_em(d, "the observations' noise");
}

SmoothLds::Out SmoothLds::operator()(const Lds& model, const Track& track, Context& context) const {
  require_frames_of(track, model.dimension(), "the linear dynamical system");
  Out out{{Eigen::MatrixXd(0, model.states()), track.rate, track.start, {}, track.lost}, track};
  if (track.frames() == 0) return out;
  LdsPosterior p =
      smooth ? kalman_smoother(model, track.values, track.lost) : kalman_filter(model, track.values, track.lost);
  context.log(fmt::format("log-likelihood {:.8g}, {:.5g} a frame", p.log_likelihood,
                          p.log_likelihood / static_cast<double>(track.frames())));
  out.track.values = observations(model, p.means);
  out.states.values = std::move(p.means);
  return out;
}

void describe(Description<SmoothLds>& d) {
  d.type("latent.lds_smooth").version(1);
  d.summary("the states of a track under a linear dynamical system, and the frames that they give");
  d.source("Thesis §4.2.4; Kalman 1960; Rauch, Tung and Striebel 1965");
  d.input("model", "trained on features of this kind").input("track", "of the features that the model was trained on");
  d.output("states", &SmoothLds::Out::states, "means, T × d");
  d.output("track", &SmoothLds::Out::track, "what the states give without noise, T × D");
  d.param("smooth", &SmoothLds::smooth)
      .doc("states given all frames; otherwise given those up to theirs (Kalman filter)");
}

}  // namespace talkgraph
