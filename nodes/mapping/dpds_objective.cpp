#include "nodes/mapping/dpds_objective.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace talkgraph {

namespace {

/// What a sequence's frames depend on: μ of its first state, ν of the others.
std::vector<Eigen::Index> unknowns_of(const std::vector<Eigen::Index>& states, Eigen::Index count) {
  std::vector<Eigen::Index> unknowns;
  for (std::size_t t = 1; t < states.size(); ++t) unknowns.push_back(count + states[t]);
  unknowns.push_back(states[0]);
  std::sort(unknowns.begin(), unknowns.end());
  unknowns.erase(std::unique(unknowns.begin(), unknowns.end()), unknowns.end());
  return unknowns;
}

}  // namespace

DpdsObjective::DpdsObjective(const StateRuns& runs, const Eigen::VectorXd& frames, double least_noise, double bound)
    : runs_(runs), frames_(frames), least_noise_(least_noise), bound_(bound) {
  for (const auto& states : runs.sequences) unknowns_.push_back(unknowns_of(states, runs.states));
}

/// Least squares of μ and ν: row t of the design is A times row t − 1, plus 1 in the column of the state's ν.
bool DpdsObjective::solve() {
  const Eigen::Index count = runs_.states;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * count);
  Eigen::Index from = 0;
  for (std::size_t s = 0; s < runs_.sequences.size(); ++s) {
    const auto& states = runs_.sequences[s];
    const auto& unknowns = unknowns_[s];
    const auto column = [&](Eigen::Index unknown) {
      return std::lower_bound(unknowns.begin(), unknowns.end(), unknown) - unknowns.begin();
    };
    const Eigen::Index length = std::ssize(states);
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(std::ssize(unknowns), length);
    design(column(states[0]), 0) = 1;
    for (Eigen::Index t = 1; t < length; ++t) {
      const Eigen::Index state = states[static_cast<std::size_t>(t)];
      design.col(t) = prediction_[state] * design.col(t - 1);
      design(column(count + state), t) += 1;
    }
    normal(unknowns, unknowns) += design * design.transpose();
    right(unknowns) += design * frames_.segment(from, length);
    from += length;
  }
  for (Eigen::Index i = 0; i < 2 * count; ++i)
    if (normal(i, i) == 0) normal(i, i) = 1;
  const Eigen::LDLT<Eigen::MatrixXd> factors(normal);
  const Eigen::VectorXd solution = factors.solve(right);
  first_ = solution.head(count);
  offset_ = solution.tail(count);
  return factors.isPositive() && solution.allFinite();
}

Eigen::VectorXd DpdsObjective::path(const std::vector<Eigen::Index>& states) const {
  Eigen::VectorXd x(std::ssize(states));
  x[0] = first_[states[0]];
  for (Eigen::Index t = 1; t < x.size(); ++t) {
    const Eigen::Index state = states[static_cast<std::size_t>(t)];
    x[t] = prediction_[state] * x[t - 1] + offset_[state];
  }
  return x;
}

bool DpdsObjective::evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) {
  prediction_ = bound_ > 0 ? Eigen::VectorXd(bound_ * parameters.array().tanh()) : parameters;
  if (!solve()) return false;
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(runs_.states);  // of half the squared error
  double squares = 0;
  Eigen::Index from = 0;
  for (const auto& states : runs_.sequences) {
    const Eigen::VectorXd x = path(states), error = x - frames_.segment(from, x.size());
    squares += error.squaredNorm();
    from += x.size();
    double carried = 0;
    for (Eigen::Index t = x.size() - 1; t > 0; --t) {
      const Eigen::Index state = states[static_cast<std::size_t>(t)];
      carried += error[t];
      slope[state] += carried * x[t - 1];
      carried *= prediction_[state];
    }
  }
  const auto frames = static_cast<double>(frames_.size());
  noise_ = std::max(squares / frames, least_noise_);
  cost = 0.5 * (frames * std::log(2 * std::numbers::pi * noise_) + squares / noise_);
  if (gradient) {
    *gradient = slope / noise_;
    if (bound_ > 0) gradient->array() *= bound_ - prediction_.array().square() / bound_;
  }
  return std::isfinite(cost);
}

}  // namespace talkgraph
