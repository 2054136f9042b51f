#include "nodes/latent/lds.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "nodes/latent/em.h"
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

/// Frames and B in units of the observation noise.
struct Whitened {
  Whitened(const Lds& model, const Eigen::MatrixXd& frames)
      : columns((frames.rowwise() - model.mean).transpose()), observation(model.observation) {
    if (model.observation_noise.cols() == 1) {
      if (!(model.observation_noise.array() > 0).all()) refuse("the observations' noise", model.dimension());
      const Eigen::VectorXd deviations = model.observation_noise.cwiseSqrt();
      columns = deviations.cwiseInverse().asDiagonal() * columns;
      observation = deviations.cwiseInverse().asDiagonal() * observation;
      log_determinant = 2 * deviations.array().log().sum();
    } else {
      const Root root = root_of(model.observation_noise, "the observations' noise");
      root.matrixL().solveInPlace(columns);
      root.matrixL().solveInPlace(observation);
      log_determinant = 2 * root.matrixLLT().diagonal().array().log().sum();
    }
    precision = observation.transpose() * observation;
  }
  Eigen::MatrixXd columns, observation;  ///< D × T, D × d
  Eigen::MatrixXd precision;             ///< BᵀΓ⁻¹B
  double log_determinant = 0;            ///< ln|Γ|
};

/// What a filter predicts of a frame's state from those before it.
struct Prediction {
  Eigen::VectorXd mean;
  Root covariance;
};

struct Filtered {
  LdsPosterior posterior;
  std::vector<Prediction> predictions;  ///< T
};

Prediction predict(const Lds& model, const LdsPosterior& p, Eigen::Index t) {
  if (t == 0) return {model.first_mean, root_of(model.first_covariance, "the first state")};
  const Eigen::MatrixXd& before = p.covariances.back();
  return {
      model.prediction * p.means.row(t - 1).transpose() + model.offset,
      root_of(model.prediction * before * model.prediction.transpose() + model.prediction_noise, "a predicted state")};
}

Filtered filter(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  const Whitened white(model, frames);
  const double constant =
      white.log_determinant + static_cast<double>(model.dimension()) * std::log(2 * std::numbers::pi);
  Filtered f;
  f.posterior.means.resize(frames.rows(), model.states());
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    f.predictions.push_back(predict(model, f.posterior, t));
    const Prediction& predicted = f.predictions.back();
    if (std::binary_search(lost.begin(), lost.end(), t)) {
      f.posterior.means.row(t) = predicted.mean.transpose();
      f.posterior.covariances.push_back(predicted.covariance.reconstructedMatrix());
      continue;
    }
    const Eigen::MatrixXd l = predicted.covariance.matrixL();
    Eigen::MatrixXd inner = l.transpose() * white.precision * l;
    inner.diagonal().array() += 1;
    const Root root = root_of(inner, "an observed state");
    Eigen::VectorXd error = white.columns.col(t) - white.observation * predicted.mean;
    const Eigen::VectorXd step = root.solve(l.transpose() * (white.observation.transpose() * error));
    f.posterior.means.row(t) = (predicted.mean + l * step).transpose();
    const Eigen::MatrixXd half = root.matrixL().solve(l.transpose());
    f.posterior.covariances.push_back(half.transpose() * half);
    error -= white.observation * (l * step);
    f.posterior.log_likelihood -= 0.5 * (constant + 2 * root.matrixLLT().diagonal().array().log().sum() +
                                         error.squaredNorm() + step.squaredNorm());
  }
  return f;
}

/// Sums of expectations over all frames.
struct Expectations {
  Expectations(Eigen::Index d)
      : from(Eigen::MatrixXd::Zero(d + 1, d + 1)),
        to(Eigen::MatrixXd::Zero(d, d)),
        across(Eigen::MatrixXd::Zero(d, d + 1)),
        first(Eigen::MatrixXd::Zero(0, d)),
        first_covariance(Eigen::MatrixXd::Zero(d, d)),
        covariance(Eigen::MatrixXd::Zero(d, d)),
        means(0, d) {}

  void add(const LdsPosterior& p) {
    const Eigen::Index frames = p.means.rows(), d = p.means.cols();
    Eigen::MatrixXd extended(frames, d + 1);
    extended << p.means, Eigen::VectorXd::Ones(frames);
    from += extended.topRows(frames - 1).transpose() * extended.topRows(frames - 1);
    to += p.means.bottomRows(frames - 1).transpose() * p.means.bottomRows(frames - 1);
    across += p.means.bottomRows(frames - 1).transpose() * extended.topRows(frames - 1);
    for (std::size_t t = 0; t < p.covariances.size(); ++t) {
      covariance += p.covariances[t];
      if (t + 1 < p.covariances.size()) from.topLeftCorner(d, d) += p.covariances[t];
      if (t > 0) to += p.covariances[t];
      if (t > 0) across.leftCols(d) += p.lagged[t - 1];
    }
    first.conservativeResize(first.rows() + 1, Eigen::NoChange);
    first.bottomRows(1) = p.means.topRows(1);
    first_covariance += p.covariances.front();
    means.conservativeResize(means.rows() + frames, Eigen::NoChange);
    means.bottomRows(frames) = p.means;
  }

  Eigen::MatrixXd from, to, across;  ///< of [x_{t−1}; 1], x_t, and the one with the other
  Eigen::MatrixXd first;             ///< means of first states, S × d
  Eigen::MatrixXd first_covariance, covariance;
  Eigen::MatrixXd means;  ///< N × d
};

struct Floors {
  Eigen::VectorXd states, observations;
};

void maximise_dynamics(Lds& model, const Expectations& e, const Floors& floors) {
  const Eigen::Index d = model.states();
  const double steps = e.from(d, d);
  if (steps == 0) return;
  const Eigen::MatrixXd map = root_of(e.from, "the states").solve(e.across.transpose()).transpose();
  model.prediction = map.leftCols(d);
  model.offset = map.col(d);
  const Eigen::MatrixXd shared = map * e.across.transpose();
  const Eigen::MatrixXd left = e.to - shared - shared.transpose() + map * e.from * map.transpose();
  model.prediction_noise = floored(0.5 / steps * (left + left.transpose()), floors.states);
}

void maximise(Lds& model, const Eigen::MatrixXd& frames, const Expectations& e, const Floors& floors,
              CovarianceKind kind) {
  const double count = static_cast<double>(frames.rows()), sequences = static_cast<double>(e.first.rows());
  maximise_dynamics(model, e, floors);

  model.first_mean = e.first.colwise().mean().transpose();
  const Eigen::MatrixXd spread = e.first.rowwise() - model.first_mean.transpose();
  model.first_covariance = floored((spread.transpose() * spread + e.first_covariance) / sequences, floors.states);

  const Eigen::MatrixXd centred = frames.rowwise() - model.mean;
  const Eigen::MatrixXd squares = e.means.transpose() * e.means + e.covariance;
  model.observation = root_of(squares, "the states").solve(e.means.transpose() * centred).transpose();
  const Eigen::MatrixXd errors = centred - e.means * model.observation.transpose();
  Eigen::MatrixXd noise = scatter(errors, Eigen::VectorXd::Ones(frames.rows()), kind);
  const Eigen::MatrixXd hidden = model.observation * (e.covariance / count) * model.observation.transpose();
  noise += kind == CovarianceKind::full ? hidden : Eigen::MatrixXd(hidden.diagonal());
  model.observation_noise = floored(noise, floors.observations);
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

Lds start_lds(const Sequences& data, const TrainLds& options, const Floors& floors) {
  const Eigen::Index d = options.latent_dimension, dims = data.frames.cols();
  const Eigen::MatrixXd rows = stacked(data, (d + dims - 1) / dims);
  const Ppca ppca = fit_ppca(rows, d);
  const Eigen::MatrixXd x = ppca.posterior_mean(rows), covariance = ppca.posterior_covariance();
  Expectations e(d);
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
  maximise(model, data.frames, e, floors, options.covariance);
  model.first_covariance.setIdentity(d, d);
  return model;
}

double expect(const Lds& model, const Sequences& data, Expectations& e) {
  e = Expectations(model.states());
  double log_likelihood = 0;
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    const LdsPosterior p = kalman_smoother(model, data.frames.middleRows(from, length));
    e.add(p);
    log_likelihood += p.log_likelihood;
    from += length;
  }
  return log_likelihood;
}

}  // namespace

LdsPosterior kalman_filter(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  return filter(model, frames, lost).posterior;
}

LdsPosterior kalman_smoother(const Lds& model, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  Filtered f = filter(model, frames, lost);
  LdsPosterior& p = f.posterior;
  p.lagged.resize(p.covariances.size() - 1);
  for (std::size_t t = p.lagged.size(); t-- > 0;) {
    const auto row = static_cast<Eigen::Index>(t);
    const Prediction& next = f.predictions[t + 1];
    Eigen::MatrixXd& covariance = p.covariances[t];
    const Eigen::MatrixXd gain = next.covariance.solve(model.prediction * covariance).transpose();
    p.means.row(row) += (gain * (p.means.row(row + 1).transpose() - next.mean)).transpose();
    const Eigen::MatrixXd& after = p.covariances[t + 1];
    p.lagged[t] = after * gain.transpose();
    const Eigen::MatrixXd kept = Eigen::MatrixXd::Identity(gain.rows(), gain.rows()) - gain * model.prediction;
    covariance = kept * covariance * kept.transpose() + gain * (model.prediction_noise + after) * gain.transpose();
  }
  return std::move(p);
}

Eigen::MatrixXd observations(const Lds& model, const Eigen::MatrixXd& states) {
  return (states * model.observation.transpose()).rowwise() + model.mean;
}

Lds TrainLds::fit(const Sequences& data, Context& context) const {
  const Floors floors{Eigen::VectorXd::Constant(latent_dimension, state_floor), variance_floors(data.frames, floor)};
  Lds model = start_lds(data, *this, floors);
  Expectations given(model.states());
  model.trace = run_em(
      {iterations, tolerance}, data.frames.rows(), fmt::format("LDS of {} state dimensions", model.states()), context,
      [&] { return expect(model, data, given); }, [&] { maximise(model, data.frames, given, floors, covariance); });
  return model;
}

Lds TrainLds::operator()(const Collected<Track>& tracks, Context& context) const {
  return fit(measured_runs(tracks), context);
}

void describe(Description<TrainLds>& d) {
  d.type("latent.lds").version(2).stored();
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
