#include "nodes/latent/lds_expectations.h"

#include <Eigen/Eigenvalues>
#include <numeric>
#include <stdexcept>

namespace talkgraph {

namespace {

Eigen::LLT<Eigen::MatrixXd> root_of(const Eigen::MatrixXd& squares) {
  Eigen::LLT<Eigen::MatrixXd> root(squares);
  if (root.info() != Eigen::Success)
    throw std::runtime_error(
        "linear dynamical system: its states do not span their space: raise the floors of training");
  return root;
}

double radius(const Eigen::MatrixXd& prediction) { return prediction.eigenvalues().cwiseAbs().maxCoeff(); }

/// The share of the way from one A to another that keeps to a limit, found to a thousandth.
double share_within(double limit, const Eigen::MatrixXd& from, const Eigen::MatrixXd& to) {
  if (!std::isfinite(limit) || radius(to) <= limit) return 1;
  double within = 0, beyond = 1;
  while (beyond - within > 1e-3) {
    const double middle = 0.5 * (within + beyond);
    (radius(from + middle * (to - from)) <= limit ? within : beyond) = middle;
  }
  return within;
}

void maximise_dynamics(Lds& model, const LdsExpectations& e, const LdsConstraints& constraints) {
  const Eigen::Index d = model.states();
  const double steps = e.from(d, d);
  if (steps == 0) return;
  Eigen::MatrixXd map = root_of(e.from).solve(e.across.transpose()).transpose();
  const double share = share_within(constraints.limits.radius, model.prediction, map.leftCols(d));
  if (share < 1) {
    map *= share;
    map.leftCols(d) += (1 - share) * model.prediction;
    map.col(d) += (1 - share) * model.offset;
  }
  model.prediction = map.leftCols(d);
  model.offset = map.col(d);
  const Eigen::MatrixXd shared = map * e.across.transpose();
  const Eigen::MatrixXd left = e.to - shared - shared.transpose() + map * e.from * map.transpose();
  model.prediction_noise = floored(0.5 / steps * (left + left.transpose()), constraints.state_floors);
}

void maximise_first(Lds& model, const LdsExpectations& e, const LdsConstraints& constraints) {
  const auto sequences = static_cast<double>(e.first.rows());
  if (sequences == 0) return;
  model.first_mean = e.first.colwise().mean().transpose();
  const Eigen::MatrixXd spread = e.first.rowwise() - model.first_mean.transpose();
  model.first_covariance =
      floored((spread.transpose() * spread + e.first_covariance) / sequences, constraints.state_floors);
}

/// Without the covariances of the first `apart` dimensions with the others.
Eigen::MatrixXd separated(Eigen::MatrixXd covariance, Eigen::Index apart) {
  if (covariance.cols() == 1) return covariance;
  const Eigen::Index others = covariance.rows() - apart;
  covariance.topRightCorner(apart, others).setZero();
  covariance.bottomLeftCorner(others, apart).setZero();
  return covariance;
}

}  // namespace

LdsExpectations::LdsExpectations(Eigen::Index d)
    : from(Eigen::MatrixXd::Zero(d + 1, d + 1)),
      to(Eigen::MatrixXd::Zero(d, d)),
      across(Eigen::MatrixXd::Zero(d, d + 1)),
      first(Eigen::MatrixXd::Zero(0, d)),
      first_covariance(Eigen::MatrixXd::Zero(d, d)),
      covariance(Eigen::MatrixXd::Zero(d, d)),
      means(0, d) {}

void LdsExpectations::add(const LdsPosterior& p, const std::vector<Eigen::Index>& times) {
  if (times.empty()) return;
  const Eigen::Index d = p.means.cols(), begins = times.front() == 0 ? 1 : 0;
  const std::vector<Eigen::Index> after(times.begin() + begins, times.end());
  const auto steps = static_cast<Eigen::Index>(after.size());
  Eigen::MatrixXd before(steps, d + 1), reached(steps, d);
  for (Eigen::Index i = 0; i < steps; ++i) {
    const Eigen::Index t = after[static_cast<std::size_t>(i)];
    before.row(i) << p.means.row(t - 1), 1;
    reached.row(i) = p.means.row(t);
    from.topLeftCorner(d, d) += p.covariances[static_cast<std::size_t>(t - 1)];
    to += p.covariances[static_cast<std::size_t>(t)];
    across.leftCols(d) += p.lagged[static_cast<std::size_t>(t - 1)];
  }
  from += before.transpose() * before;
  to += reached.transpose() * reached;
  across += reached.transpose() * before;
  first.conservativeResize(first.rows() + begins, Eigen::NoChange);
  first.bottomRows(begins) = p.means.topRows(begins);
  if (begins) first_covariance += p.covariances.front();
  means.conservativeResize(means.rows() + std::ssize(times), Eigen::NoChange);
  means.bottomRows(std::ssize(times)) = p.means(times, Eigen::all);
  for (const Eigen::Index t : times) covariance += p.covariances[static_cast<std::size_t>(t)];
}

void LdsExpectations::add(const LdsPosterior& p) {
  std::vector<Eigen::Index> times(p.covariances.size());
  std::iota(times.begin(), times.end(), 0);
  add(p, times);
}

void maximise(Lds& model, const Eigen::MatrixXd& frames, const LdsExpectations& e, const LdsConstraints& constraints) {
  maximise_dynamics(model, e, constraints);
  maximise_first(model, e, constraints);
  const Eigen::MatrixXd centred = frames.rowwise() - model.mean;
  const Eigen::MatrixXd squares = e.means.transpose() * e.means + e.covariance;
  model.observation = root_of(squares).solve(e.means.transpose() * centred).transpose();
  const Eigen::MatrixXd errors = centred - e.means * model.observation.transpose();
  Eigen::MatrixXd noise = scatter(errors, Eigen::VectorXd::Ones(frames.rows()), constraints.covariance);
  const Eigen::MatrixXd hidden =
      model.observation * (e.covariance / static_cast<double>(frames.rows())) * model.observation.transpose();
  noise += constraints.covariance == CovarianceKind::full ? hidden : Eigen::MatrixXd(hidden.diagonal());
  const Eigen::Index apart = constraints.limits.apart;
  model.observation_noise = separated(floored(separated(noise, apart), constraints.noise_floors), apart);
}

}  // namespace talkgraph
