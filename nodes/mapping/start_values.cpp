#include "nodes/mapping/start_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "graph/random.h"
#include "nodes/latent/clock.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/predictive.h"

namespace talkgraph {

namespace {

/// Frame of a window of `window` frames that frame t of `length` stands beside.
Eigen::Index partner(Eigen::Index t, Eigen::Index length, Eigen::Index window, Eigen::Index offset) {
  if (length <= window) return offset + t;
  return static_cast<Eigen::Index>(
      std::lround(static_cast<double>(t * (window - 1)) / static_cast<double>(length - 1)));
}

/// Rows of the training points that serve as states.
std::vector<Eigen::Index> some_of(Eigen::Index points, Eigen::Index most) {
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(points));
  std::iota(rows.begin(), rows.end(), 0);
  if (most == 0 || points <= most) return rows;
  Random random(1);
  random.shuffle(rows);
  rows.resize(static_cast<std::size_t>(most));
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// ln N(a_i; mean_j, variance_j I) of every row of a and of the means.
Eigen::MatrixXd log_densities(const Eigen::MatrixXd& a, const Eigen::MatrixXd& means,
                              const Eigen::VectorXd& variances) {
  Eigen::MatrixXd squares = -2 * a * means.transpose();
  squares.colwise() += a.rowwise().squaredNorm();
  squares.rowwise() += means.rowwise().squaredNorm().transpose();
  const Eigen::RowVectorXd normaliser =
      static_cast<double>(a.cols()) * (variances.array() * (2 * std::numbers::pi)).log();
  return -0.5 * ((squares.array().max(0.0).rowwise() / variances.transpose().array()).rowwise() + normaliser.array());
}

/// ln p of each state at each frame given its time, T × states.
Eigen::MatrixXd log_densities_in_time(const Sgpdm& state, const Eigen::MatrixXd& points, Eigen::Index frames) {
  Predictive h;
  h.compute(*state.dynamics, times_of({frames}, state.form));
  return log_densities(points, h.mean(), h.variance()).transpose();
}

/// ln p of each step, from the state of a row to that of a column.
Eigen::MatrixXd log_transitions(const Sgpdm& state, const Eigen::MatrixXd& points) {
  if (!state.dynamics) return Eigen::MatrixXd::Zero(points.rows(), points.rows());
  Predictive h;
  h.compute(*state.dynamics, points);
  Eigen::MatrixXd next = h.mean();
  if (state.form == DynamicsForm::difference) next += points;
  return log_densities(points, next, h.variance()).transpose();
}

}  // namespace

Eigen::MatrixXd nearest_frames(const Sgpdm& state, const Eigen::MatrixXd& audio) {
  Eigen::MatrixXd x(audio.rows(), state.latents.cols());
  for (Eigen::Index t = 0; t < audio.rows(); ++t) {
    Eigen::Index nearest = 0;
    (state.audio_frames.rowwise() - audio.row(t)).rowwise().squaredNorm().minCoeff(&nearest);
    x.row(t) = state.latents.row(nearest);
  }
  return x;
}

Eigen::MatrixXd nearest_window(const Sgpdm& state, const Eigen::MatrixXd& audio) {
  const Eigen::Index length = audio.rows();
  double least = std::numeric_limits<double>::infinity();
  Eigen::Index best_start = 0, best_offset = 0, best_window = 1, start = 0;
  for (const auto window : state.lengths) {
    for (Eigen::Index offset = 0; offset <= std::max<Eigen::Index>(0, window - length); ++offset) {
      double distance = 0;
      for (Eigen::Index t = 0; t < length && distance < least; ++t)
        distance += (state.audio_frames.row(start + partner(t, length, window, offset)) - audio.row(t)).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      best_start = start;
      best_offset = offset;
      best_window = window;
    }
    start += window;
  }
  Eigen::MatrixXd x(length, state.latents.cols());
  for (Eigen::Index t = 0; t < length; ++t)
    x.row(t) = state.latents.row(best_start + partner(t, length, best_window, best_offset));
  return x;
}

Eigen::MatrixXd likeliest_path(const Sgpdm& state, const Eigen::MatrixXd& audio, Eigen::Index most) {
  const Eigen::MatrixXd points = state.latents(some_of(state.latents.rows(), most), Eigen::all);
  Predictive f;
  f.compute(state.audio, points);
  Eigen::MatrixXd observations = log_densities(audio, f.mean(), f.variance());
  MarkovChain chain{Eigen::MatrixXd::Zero(points.rows(), 1), Eigen::MatrixXd::Zero(points.rows(), points.rows())};
  if (state.dynamics && is_timed(state.form)) {
    observations += log_densities_in_time(state, points, audio.rows());
  } else {
    const Eigen::VectorXd nowhere = Eigen::VectorXd::Constant(1, state.first_variance);
    chain = {log_densities(points, Eigen::MatrixXd::Zero(1, points.cols()), nowhere), log_transitions(state, points)};
  }
  const auto path = viterbi(chain, observations).states;
  return points(path, Eigen::all);
}

}  // namespace talkgraph
