#include "nodes/latent/stochastic_training.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talkgraph {

namespace {

/// Adaptive moments of a gradient to be followed upwards.
class Adam {
 public:
  explicit Adam(Eigen::Index size) : mean_(Eigen::ArrayXd::Zero(size)), square_(Eigen::ArrayXd::Zero(size)) {}

  /// Step `count` (from 1) of some of the parameters.
  template <class Indices>
  void step(const Indices& at, const Eigen::ArrayXd& gradient, int count, double rate, Eigen::VectorXd& parameters) {
    constexpr double keep_mean = 0.9, keep_square = 0.99, least = 1e-8;
    mean_(at) = keep_mean * mean_(at) + (1 - keep_mean) * gradient;
    square_(at) = keep_square * square_(at) + (1 - keep_square) * gradient.square();
    const double mean_weight = 1 / (1 - std::pow(keep_mean, count));
    const double square_weight = 1 / (1 - std::pow(keep_square, count));
    parameters(at).array() += rate * mean_weight * mean_(at) / ((square_weight * square_(at)).sqrt() + least);
  }

 private:
  Eigen::ArrayXd mean_, square_;
};

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

class Training {
 public:
  Training(const StochasticTraining& settings, BayesianObjective& objective)
      : settings_(settings), objective_(objective), parameters_(objective.start()), adam_(objective.size()) {
    q_.set_zero(objective.rows(), objective.dimension());
    by_q_ = q_;
  }

  void step(const std::vector<std::size_t>& windows, int epoch) {
    const LatentPosterior& latents = objective_.latents();
    const std::vector<Eigen::Index> rows = rows_of(windows);
    const double all = static_cast<double>(objective_.rows()), scale = all / static_cast<double>(rows.size());
    const double natural_step = std::max(1.0 / ++steps_, std::min(0.5, 2 / scale));
    const double rate_share = 1 - 0.9 * epoch / settings_.epochs;

    const Eigen::Index n = objective_.rows() * objective_.dimension();
    const Eigen::Map<const Eigen::MatrixXd> mean(parameters_.data(), objective_.rows(), objective_.dimension());
    const Eigen::Map<const Eigen::MatrixXd> precision(parameters_.data() + n, mean.rows(), mean.cols());
    latents.compute(windows, mean, precision, q_.mean, q_.variance);
    by_q_.mean(rows, Eigen::all).setZero();
    by_q_.variance(rows, Eigen::all).setZero();
    std::vector<Eigen::VectorXd> gradients;
    for (std::size_t i = 0; i < objective_.streams().size(); ++i) {
      VariationalStream& s = objective_.streams()[i];
      s.begin(parameters_.segment(objective_.place(i), s.size()));
      gradients.emplace_back(s.size());
      s.stochastic(s.classes_of(rows), scale, natural_step, q_, by_q_, gradients.back());
    }
    by_q_.mean(rows, Eigen::all) /= scale;
    by_q_.variance(rows, Eigen::all) /= scale;
    latents.gradient(windows, mean, precision, by_q_.mean, by_q_.variance);

    for (std::size_t i = 0; i < gradients.size(); ++i) {
      if (epoch < settings_.noise_held) gradients[i][objective_.streams()[i].noise_place()] = 0;
      adam_.step(Eigen::seqN(objective_.place(i), gradients[i].size()), gradients[i], steps_,
                 rate_share * settings_.rate, parameters_);
    }
    move_latents(rows, epoch + 1, rate_share * settings_.latent_rate);
  }

  const Eigen::VectorXd& parameters() const { return parameters_; }

 private:
  std::vector<Eigen::Index> rows_of(const std::vector<std::size_t>& windows) const {
    std::vector<Eigen::Index> rows;
    for (const auto w : windows)
      for (Eigen::Index t = 0; t < objective_.latents().length(w); ++t)
        rows.push_back(objective_.latents().start(w) + t);
    return rows;
  }

  void move_latents(const std::vector<Eigen::Index>& rows, int count, double rate) {
    for (Eigen::Index c = 0; c < 2 * objective_.dimension(); ++c) {
      const Eigen::Index q = c % objective_.dimension();
      const Eigen::MatrixXd& by = c < objective_.dimension() ? by_q_.mean : by_q_.variance;
      std::vector<Eigen::Index> at = rows;
      for (auto& row : at) row += c * objective_.rows();
      adam_.step(at, by(rows, q).array(), count, rate, parameters_);
    }
  }

  const StochasticTraining& settings_;
  BayesianObjective& objective_;
  Eigen::VectorXd parameters_;
  Adam adam_;
  GaussianRows q_, by_q_;
  int steps_ = 0;
};

}  // namespace

StochasticTraining::Reached StochasticTraining::operator()(BayesianObjective& objective, Random& random) const {
  Training training(*this, objective);
  Reached reached{training.parameters(), {objective.value(training.parameters(), nullptr)}, false};
  std::vector<double> best = reached.trace;
  for (int epoch = 0; epoch < epochs && !reached.converged; ++epoch) {
    const auto parts = parts_of(objective.latents(), batch, random);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      training.step(parts[i], epoch);
      if (on_part) on_part((epoch + static_cast<double>(i + 1) / static_cast<double>(parts.size())) / epochs);
    }
    reached.trace.push_back(objective.value(training.parameters(), nullptr));
    if (reached.trace.back() > best.back()) reached.parameters = training.parameters();
    best.push_back(std::max(best.back(), reached.trace.back()));
    const auto before = std::ssize(best) - 1 - patience;
    reached.converged = before >= std::max(1, noise_held) && best.back() - best[static_cast<std::size_t>(before)] <
                                                                 tolerance * static_cast<double>(objective.rows());
  }
  return reached;
}

}  // namespace talkgraph
