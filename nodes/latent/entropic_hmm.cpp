#include "nodes/latent/entropic_hmm.h"

#include <fmt/format.h>

#include <cmath>

#include "nodes/latent/em.h"
#include "nodes/latent/hmm.h"

namespace talkgraph {

namespace {

/// Newton's method on a convex function from a point right of its right root.
template <class Step>
double descend(double x, Step step) {
  for (;;) {
    const double next = x - step(x);
    if (!(next < x)) return x;
    x = next;
  }
}

/// The solution u ≥ 1 of u − ln u = c, c ≥ 1: −W(−e^{−c}) of the lower branch, where e^{−c} may underflow.
double above_one(double c) {
  const double start = c + std::sqrt(2 * (c - 1));
  return descend(start, [c](double u) { return (u - std::log(u) - c) / (1 - 1 / u); });
}

/// That with u ≤ 1, of the principal branch.
double below_one(double c) {
  return std::exp(-descend(c, [c](double v) { return (std::exp(-v) + v - c) / -std::expm1(-v); }));
}

/// ω_i / u_i, where u_i − ln u_i = level − ln ω_i.
Eigen::VectorXd at_level(const Eigen::VectorXd& evidence, double level, bool concentrated) {
  Eigen::Index largest;
  evidence.maxCoeff(&largest);
  Eigen::VectorXd p = Eigen::VectorXd::Zero(evidence.size());
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    if (evidence(i) == 0) continue;
    const double c = std::max(1.0, level - std::log(evidence(i)));
    p(i) = evidence(i) / (concentrated && i == largest ? below_one(c) : above_one(c));
  }
  return p;
}

double gaussian_entropy(const Eigen::MatrixXd& covariance) {
  if (covariance.cols() == 1) return 0.5 * covariance.array().log().sum();
  return Eigen::LLT<Eigen::MatrixXd>(covariance).matrixLLT().diagonal().array().log().sum();
}

double model_entropy(const Hmm& model) {
  double sum = entropy(model.start);
  for (Eigen::Index k = 0; k < model.states(); ++k)
    sum += entropy(model.transitions.row(k).transpose()) +
           gaussian_entropy(model.observations[static_cast<std::size_t>(k)].covariances[0]);
  return sum;
}

/// What the posterior gains without an entry p that has a count below 1, of a distribution whose entropy is given. No
/// terms cancel, as p may be tiny.
double gain_without(double p, double count, double entropy, double other_counts, double prior) {
  const double rest = std::log1p(-p);
  return prior * (-p * (entropy + std::log(p)) / (1 - p) - rest) - other_counts * rest + std::log1p(-count);
}

void maximise(Hmm& model, const Sequences& data, const HmmExpectations& e, const Eigen::VectorXd& floors,
              const EntropicHmm& options) {
  model.start = entropic_estimate(e.starts, options.prior);
  for (Eigen::Index k = 0; k < model.states(); ++k) {
    const Eigen::VectorXd steps = e.steps.row(k);
    if (steps.sum() > 1e-12) model.transitions.row(k) = entropic_estimate(steps, options.prior);
    const double occupancy = e.states.col(k).sum();
    if (occupancy <= 1e-12) continue;
    GaussianMixture& gaussian = model.observations[static_cast<std::size_t>(k)];
    gaussian.means = e.states.col(k).transpose() * data.frames / occupancy;
    const Eigen::MatrixXd sample =
        scatter(data.frames.rowwise() - gaussian.means.row(0), e.states.col(k), options.covariance);
    gaussian.covariances[0] = floored(sample * (occupancy / (occupancy + options.prior)), floors);
  }
}

bool trim_transitions(Hmm& model, const HmmExpectations& e, double prior) {
  bool trimmed = trim(model.start, e.starts, prior);
  for (Eigen::Index k = 0; k < model.states(); ++k) {
    Eigen::VectorXd row = model.transitions.row(k);
    trimmed |= trim(row, e.steps.row(k), prior);
    model.transitions.row(k) = row;
  }
  return trimmed;
}

}  // namespace

double entropy(const Eigen::VectorXd& distribution) {
  double sum = 0;
  for (const double p : distribution)
    if (p > 0) sum -= p * std::log(p);
  return sum;
}

Eigen::VectorXd entropic_estimate(const Eigen::VectorXd& counts, double prior) {
  if (prior == 0) return counts / counts.sum();
  const Eigen::VectorXd evidence = counts / prior;
  const double lowest = 1 + std::log(evidence.maxCoeff());
  const bool concentrated = at_level(evidence, lowest, false).sum() < 1;
  const auto beyond = [&](double level) { return (at_level(evidence, level, concentrated).sum() < 1) != concentrated; };
  double low = lowest, width = 1;
  while (!beyond(lowest + width)) width *= 2;
  double high = lowest + width;
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) break;
    (beyond(middle) ? high : low) = middle;
  }
  const Eigen::VectorXd p = at_level(evidence, high, concentrated);
  return p / p.sum();
}

bool trim(Eigen::VectorXd& distribution, Eigen::VectorXd counts, double prior) {
  for (bool trimmed = false;; trimmed = true) {
    const double all_entropy = entropy(distribution), all_counts = counts.sum();
    Eigen::Index worst = -1;
    double most = 0;
    for (Eigen::Index i = 0; i < distribution.size(); ++i) {
      if (distribution(i) == 0 || distribution(i) == 1 || counts(i) >= 1) continue;
      const double gain = gain_without(distribution(i), counts(i), all_entropy, all_counts - counts(i), prior);
      if (gain > most) most = gain, worst = i;
    }
    if (worst < 0) return trimmed;
    distribution(worst) = counts(worst) = 0;
    distribution /= distribution.sum();
  }
}

Hmm EntropicHmm::fit(const Sequences& data, Random& random, Context& context) const {
  const Eigen::VectorXd floors = variance_floors(data.frames, floor);
  Hmm model = TrainHmm{states, 1, covariance, floor, 0}.fit(data, random, context);
  HmmExpectations given;
  const auto objective = [&] {
    const double log_likelihood = expect(model, data, given);
    return log_likelihood - prior * model_entropy(model);
  };
  model.trace.clear();
  for (int left = iterations;;) {
    const std::vector<double> trace = run_em({left, tolerance, "log-posterior"}, data.frames.rows(),
                                             fmt::format("entropic HMM of {} states, {} transitions", model.states(),
                                                         (model.transitions.array() > 0).count()),
                                             context, objective, [&] { maximise(model, data, given, floors, *this); });
    model.trace.insert(model.trace.end(), trace.begin(), trace.end());
    left -= static_cast<int>(trace.size()) - 1;
    Hmm settled = model;
    if (left == 0 || prior == 0 || !trim_transitions(model, given, prior)) return model;
    if (objective() < settled.trace.back()) return settled;
  }
}

}  // namespace talkgraph
