#include "nodes/latent/stochastic_training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>

#include "graph/random.h"

namespace talkgraph {

namespace {

std::vector<std::vector<std::size_t>> parts_of(const LatentPosterior& latents, int frames, Random& random) {
  std::vector<std::size_t> order(latents.windows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(order);
  std::vector<std::vector<std::size_t>> parts;
  Eigen::Index filled = frames;
  for (const auto w : order) {
    if (filled >= frames) {
      parts.emplace_back();
      filled = 0;
    }
    parts.back().push_back(w);
    filled += latents.length(w);
  }
  for (auto& part : parts) std::sort(part.begin(), part.end());
  return parts;
}

/// Moves some of the parameters up a gradient by Adam's step `count` (from 1).
template <class Indices>
void climb(const Indices& at, const Eigen::ArrayXd& gradient, std::int64_t count, double rate,
           StochasticTraining::State& s) {
  constexpr double keep_mean = 0.9, keep_square = 0.99, least = 1e-8;
  s.mean(at) = keep_mean * s.mean(at).array() + (1 - keep_mean) * gradient;
  s.square(at) = keep_square * s.square(at).array() + (1 - keep_square) * gradient.square();
  const double mean_weight = 1 / (1 - std::pow(keep_mean, count));
  const double square_weight = 1 / (1 - std::pow(keep_square, count));
  s.parameters(at).array() +=
      rate * mean_weight * s.mean(at).array() / ((square_weight * s.square(at).array()).sqrt() + least);
}

class Training {
 public:
  Training(const StochasticTraining& settings, BayesianObjective& objective, StochasticTraining::State& state)
      : settings_(settings), objective_(objective), state_(state) {
    q_.set_zero(objective.rows(), objective.dimension());
    by_q_ = q_;
  }

  void step(const std::vector<std::size_t>& windows, std::int64_t epoch) {
    const LatentPosterior& latents = objective_.latents();
    const std::vector<Eigen::Index> rows = rows_of(windows);
    const double all = static_cast<double>(objective_.rows()), scale = all / static_cast<double>(rows.size());
    const double natural_step = std::max(1.0 / static_cast<double>(++state_.steps), std::min(0.5, 2 / scale));
    const double rate_share = 1 - 0.9 * static_cast<double>(epoch) / settings_.epochs;

    const Eigen::Index n = objective_.rows() * objective_.dimension();
    const Eigen::Map<const Eigen::MatrixXd> mean(state_.parameters.data(), objective_.rows(), objective_.dimension());
    const Eigen::Map<const Eigen::MatrixXd> precision(state_.parameters.data() + n, mean.rows(), mean.cols());
    latents.compute(windows, mean, precision, q_.mean, q_.variance);
    by_q_.mean(rows, Eigen::all).setZero();
    by_q_.variance(rows, Eigen::all).setZero();
    std::vector<Eigen::VectorXd> gradients;
    for (std::size_t i = 0; i < objective_.streams().size(); ++i) {
      VariationalStream& s = objective_.streams()[i];
      s.begin(state_.parameters.segment(objective_.place(i), s.size()));
      gradients.emplace_back(s.size());
      s.stochastic(s.classes_of(rows), scale, natural_step, q_, by_q_, gradients.back());
    }
    by_q_.mean(rows, Eigen::all) /= scale;
    by_q_.variance(rows, Eigen::all) /= scale;
    latents.gradient(windows, mean, precision, by_q_.mean, by_q_.variance);

    for (std::size_t i = 0; i < gradients.size(); ++i) {
      if (epoch < settings_.noise_held) gradients[i][objective_.streams()[i].noise_place()] = 0;
      climb(Eigen::seqN(objective_.place(i), gradients[i].size()), gradients[i], state_.steps,
            rate_share * settings_.rate, state_);
    }
    move_latents(rows, epoch + 1, rate_share * settings_.latent_rate);
  }

 private:
  std::vector<Eigen::Index> rows_of(const std::vector<std::size_t>& windows) const {
    std::vector<Eigen::Index> rows;
    for (const auto w : windows)
      for (Eigen::Index t = 0; t < objective_.latents().length(w); ++t)
        rows.push_back(objective_.latents().start(w) + t);
    return rows;
  }

  void move_latents(const std::vector<Eigen::Index>& rows, std::int64_t count, double rate) {
    for (Eigen::Index c = 0; c < 2 * objective_.dimension(); ++c) {
      const Eigen::Index q = c % objective_.dimension();
      const Eigen::MatrixXd& by = c < objective_.dimension() ? by_q_.mean : by_q_.variance;
      std::vector<Eigen::Index> at = rows;
      for (auto& row : at) row += c * objective_.rows();
      climb(at, by(rows, q).array(), count, rate, state_);
    }
  }

  const StochasticTraining& settings_;
  BayesianObjective& objective_;
  StochasticTraining::State& state_;
  GaussianRows q_, by_q_;
};

/// Whether the last `patience` epochs, with the noise let go, gained too little.
bool converged(const StochasticTraining& settings, const std::vector<double>& trace, Eigen::Index frames) {
  const auto before = std::ssize(trace) - settings.patience;
  if (before <= std::max(1, settings.noise_held)) return false;
  const double then = *std::max_element(trace.begin(), trace.begin() + before);
  return *std::max_element(trace.begin(), trace.end()) - then < settings.tolerance * static_cast<double>(frames);
}

}  // namespace

void fields(Archive& ar, StochasticTraining::State& state) {
  ar("parameters", state.parameters);
  ar("mean", state.mean);
  ar("square", state.square);
  ar("steps", state.steps);
  ar("part", state.part);
  ar("best", state.best);
  ar("trace", state.trace);
}

void StochasticTraining::operator()(BayesianObjective& objective, State& state) const {
  const auto started = std::chrono::steady_clock::now();
  if (state.parameters.size() == 0) {
    state.parameters = state.best = objective.start();
    state.mean = state.square = Eigen::VectorXd::Zero(objective.size());
    state.trace = {objective.value(state.best, nullptr)};
  }
  Training training(*this, objective, state);
  for (auto epoch = std::ssize(state.trace) - 1; epoch < epochs; ++epoch) {
    if (converged(*this, state.trace, objective.rows())) {
      state.ended = "converged";
      return;
    }
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count() > seconds) {
      state.ended = "time limit";
      return;
    }
    Random order(seed, "parts", std::to_string(epoch));
    const auto parts = parts_of(objective.latents(), batch, order);
    double bound = 0;
    try {
      while (state.part < std::ssize(parts)) {
        training.step(parts[static_cast<std::size_t>(state.part++)], epoch);
        const double done = static_cast<double>(state.part) / static_cast<double>(parts.size());
        if (on_part) on_part((static_cast<double>(epoch) + done) / epochs);
      }
      bound = objective.value(state.parameters, nullptr);
    } catch (const FactorisationError&) {
      state.ended = "a matrix cannot be factorised";
      return;
    }
    state.part = 0;
    if (bound > *std::max_element(state.trace.begin(), state.trace.end())) state.best = state.parameters;
    state.trace.push_back(bound);
  }
  state.ended = converged(*this, state.trace, objective.rows()) ? "converged" : "epoch limit";
}

}  // namespace talkgraph
