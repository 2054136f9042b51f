#include "nodes/latent/lds.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
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

/// The frames of a sequence, each in units of the noise of the system that gives it.
struct WhitenedFrames {
  WhitenedFrames(const LdsRegimes& regimes, const Eigen::MatrixXd& frames) : columns(frames.cols(), frames.rows()) {
    std::map<const Lds*, std::vector<Eigen::Index>> times;
    for (std::size_t t = 0; t < regimes.size(); ++t) times[regimes[t]].push_back(static_cast<Eigen::Index>(t));
    for (const auto& [model, of_model] : times) {
      const auto white = systems.emplace(model, *model).first;
      columns(Eigen::all, of_model) = white->second.columns(frames(of_model, Eigen::all));
    }
  }
  std::map<const Lds*, Whitened> systems;
  Eigen::MatrixXd columns;  ///< D × T
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

Filtered filter(const LdsRegimes& regimes, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost) {
  const WhitenedFrames whitened(regimes, frames);
  const double constant = static_cast<double>(frames.cols()) * std::log(2 * std::numbers::pi);
  Filtered f;
  f.posterior.means.resize(frames.rows(), regimes.front()->states());
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    const Lds& model = *regimes[static_cast<std::size_t>(t)];
    f.predictions.push_back(predict(model, f.posterior, t));
    const Prediction& predicted = f.predictions.back();
    if (std::binary_search(lost.begin(), lost.end(), t)) {
      f.posterior.means.row(t) = predicted.mean.transpose();
      f.posterior.covariances.push_back(predicted.covariance.reconstructedMatrix());
      continue;
    }
    const Whitened& white = whitened.systems.at(&model);
    const Eigen::MatrixXd l = predicted.covariance.matrixL();
    Eigen::MatrixXd inner = l.transpose() * white.precision * l;
    inner.diagonal().array() += 1;
    const Root root = root_of(inner, "an observed state");
    Eigen::VectorXd error = whitened.columns.col(t) - white.observation * predicted.mean;
    const Eigen::VectorXd step = root.solve(l.transpose() * (white.observation.transpose() * error));
    f.posterior.means.row(t) = (predicted.mean + l * step).transpose();
    const Eigen::MatrixXd half = root.matrixL().solve(l.transpose());
    f.posterior.covariances.push_back(half.transpose() * half);
    error -= white.observation * (l * step);
    f.posterior.log_likelihood -=
        0.5 * (white.log_determinant + constant + 2 * root.matrixLLT().diagonal().array().log().sum() +
               error.squaredNorm() + step.squaredNorm());
  }
  return f;
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
  const Eigen::MatrixXd rows = stacked(data, (d + dims - 1) / dims);
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

LdsPosterior kalman_filter(const LdsRegimes& regimes, const Eigen::MatrixXd& frames,
                           const std::vector<std::int64_t>& lost) {
  return filter(regimes, frames, lost).posterior;
}

LdsPosterior kalman_smoother(const LdsRegimes& regimes, const Eigen::MatrixXd& frames,
                             const std::vector<std::int64_t>& lost) {
  Filtered f = filter(regimes, frames, lost);
  LdsPosterior& p = f.posterior;
  p.lagged.resize(p.covariances.size() - 1);
  for (std::size_t t = p.lagged.size(); t-- > 0;) {
    const auto row = static_cast<Eigen::Index>(t);
    const Lds& model = *regimes[t + 1];
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
