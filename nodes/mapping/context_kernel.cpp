#include "nodes/mapping/context_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/latent/cholesky.h"

namespace talkgraph {
namespace {

using Utterances = std::vector<const KernelExample*>;

/// A member of all utterances, one under the other.
template <class Member>
Eigen::MatrixXd joined(const Utterances& utterances, Eigen::Index columns, const Member& member) {
  Eigen::Index rows = 0;
  for (const auto* u : utterances) rows += u->targets.rows();
  Eigen::MatrixXd out(rows, columns);
  Eigen::Index at = 0;
  for (const auto* u : utterances) {
    out.middleRows(at, u->targets.rows()) = member(*u);
    at += u->targets.rows();
  }
  return out;
}

/// What the process is learnt from, and its covariance.
struct Process {
  std::vector<Eigen::MatrixXd> around;
  Eigen::MatrixXd seen;    ///< all places of the window beside each other, mapped, times the roots of their weights
  Eigen::MatrixXd kernel;  ///< without the noise
  Eigen::MatrixXd inverse;
};

Process process_of(const Utterances& utterances, const ContextKernel& k) {
  const Eigen::Index places = k.window.size(), c = k.map.cols();
  Process p;
  for (Eigen::Index l = 0; l < places; ++l)
    p.around.push_back(joined(
        utterances,
        k.map.rows(), [l](const KernelExample& u) -> const auto& { return u.around[static_cast<std::size_t>(l)]; }));
  p.seen.resize(p.around[0].rows(), places * c);
  for (Eigen::Index l = 0; l < places; ++l)
    p.seen.middleCols(l * c, c) = std::sqrt(k.window[l]) * p.around[static_cast<std::size_t>(l)] * k.map;
  const Eigen::VectorXd squares = p.seen.rowwise().squaredNorm();
  p.kernel = 2 * p.seen * p.seen.transpose();
  p.kernel.colwise() -= squares;
  p.kernel.rowwise() -= squares.transpose();
  p.kernel = p.kernel.cwiseMin(0).array().exp();
  Eigen::MatrixXd covariance = p.kernel;
  p.inverse = factorise(covariance, k.noise).solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  return p;
}

/// Derivatives of the error by ln window, map and ln noise from those by the covariance.
ContextKernel gradient_of(const Process& p, const ContextKernel& k, const Eigen::MatrixXd& by_covariance) {
  const Eigen::MatrixXd w = (by_covariance + by_covariance.transpose()).cwiseProduct(p.kernel);
  const Eigen::VectorXd rows = w.rowwise().sum();
  Eigen::MatrixXd by_seen = w * p.seen;
  by_seen -= rows.asDiagonal() * p.seen;
  by_seen *= 2;
  ContextKernel by{Eigen::RowVectorXd(k.window.size()), Eigen::MatrixXd::Zero(k.map.rows(), k.map.cols()),
                   k.noise * by_covariance.trace()};
  const Eigen::Index c = k.map.cols();
  for (Eigen::Index l = 0; l < k.window.size(); ++l) {
    const auto by_place = by_seen.middleCols(l * c, c);
    by.window[l] = 0.5 * by_place.cwiseProduct(p.seen.middleCols(l * c, c)).sum();
    by.map += std::sqrt(k.window[l]) * p.around[static_cast<std::size_t>(l)].transpose() * by_place;
  }
  return by;
}

/// One parameter, or a block of them, moved down by Adam.
class Adam {
 public:
  Adam(Eigen::Index size, double rate)
      : rate_(rate), mean_(Eigen::ArrayXd::Zero(size)), square_(Eigen::ArrayXd::Zero(size)) {}

  /// What to add at step `count`, from 1; `share` of the rate.
  Eigen::ArrayXd step(const Eigen::ArrayXd& gradient, int count, double share) {
    constexpr double keep_mean = 0.8, keep_square = 0.95, least = 1e-9;
    mean_ = keep_mean * mean_ + (1 - keep_mean) * gradient;
    square_ = keep_square * square_ + (1 - keep_square) * gradient.square();
    const Eigen::ArrayXd deviation = (square_ / (1 - std::pow(keep_square, count))).sqrt();
    return -share * rate_ * mean_ / (1 - std::pow(keep_mean, count)) / (deviation + least);
  }

 private:
  double rate_;
  Eigen::ArrayXd mean_, square_;
};

Utterances drawn(const std::vector<KernelExample>& utterances, std::size_t most, Random& random) {
  Utterances all;
  for (const auto& u : utterances) all.push_back(&u);
  random.shuffle(all);
  all.resize(std::min(all.size(), most));
  return all;
}

/// c × c: 1 where two dimensions are of one group.
Eigen::MatrixXd same_group(Eigen::Index c, const std::vector<Eigen::Index>& groups) {
  Eigen::MatrixXd same = Eigen::MatrixXd::Zero(c, c);
  Eigen::Index at = 0;
  for (const auto size : groups) {
    same.block(at, at, size, size).setOnes();
    at += size;
  }
  same.bottomRightCorner(c - at, c - at).setOnes();
  return same;
}

}  // namespace

Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factorise(Eigen::MatrixXd& covariance, double noise) {
  covariance.diagonal().array() += noise;
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(covariance);
  if (factor.info() != Eigen::Success)
    throw FactorisationError("the covariance of the training frames cannot be factorised: raise noise");
  return factor;
}

LeftOutError left_out_error(const Utterances& utterances, const ContextKernel& kernel) {
  const Process p = process_of(utterances, kernel);
  const auto d = utterances.at(0)->targets.cols();
  Eigen::MatrixXd targets = joined(
      utterances, d, [](const KernelExample& u) -> const auto& { return u.targets; });
  const Eigen::VectorXd counts = joined(
      utterances, 1, [](const KernelExample& u) -> const auto& { return u.counts; });
  targets.rowwise() -= targets.colwise().mean();
  const Eigen::MatrixXd weights = p.inverse * targets;
  const auto n = targets.rows(), columns = d * std::ssize(utterances);

  // The error of utterance u is r = (K⁻¹_uu)⁻¹ (K⁻¹ Z)_u, so that dr = (K⁻¹_uu)⁻¹ K⁻¹_u dK (K⁻¹_u r − K⁻¹ Z).
  Eigen::MatrixXd left(n, columns), right(n, columns);
  LeftOutError out;
  Eigen::Index at = 0, column = 0;
  for (const auto* u : utterances) {
    const auto size = u->targets.rows();
    const Eigen::LLT<Eigen::MatrixXd> own(p.inverse.block(at, at, size, size));
    const Eigen::MatrixXd error = own.solve(weights.middleRows(at, size));
    const Eigen::MatrixXd counted = counts.segment(at, size).asDiagonal() * error;
    out.value += counted.squaredNorm();
    left.middleCols(column, d) = p.inverse.middleCols(at, size) * own.solve(counted);
    right.middleCols(column, d) = p.inverse.middleCols(at, size) * error - weights;
    at += size;
    column += d;
  }
  const double number = counts.sum() * static_cast<double>(d);
  out.value /= number;
  out.gradient = gradient_of(p, kernel, (2 / number) * left * right.transpose());
  return out;
}

ContextKernel learn_kernel(const KernelLearning& learning, const std::vector<KernelExample>& utterances,
                           ContextKernel kernel, const std::vector<Eigen::Index>& groups, Random& random,
                           Context& context) {
  const auto c = kernel.map.rows();
  const Eigen::MatrixXd within = same_group(c, groups);
  Adam window(kernel.window.size(), 0.05), map(c * c, 0.02), noise(1, 0.05);
  for (int step = 1; step <= learning.steps; ++step) {
    context.check_cancelled();
    const auto some = drawn(utterances, static_cast<std::size_t>(learning.utterances), random);
    auto [error, by] = left_out_error(some, kernel);
    if (step == 1 || step == learning.steps)
      context.log(fmt::format("step {}: squared error of utterances left out, of their variance: {:.3f}", step, error));
    by.map.array() *= within.array();
    const double share = 1 - 0.8 * step / learning.steps;
    kernel.window.array() *= window.step(by.window.transpose(), step, share).exp().transpose();
    kernel.map.reshaped().array() += map.step(by.map.reshaped().array(), step, share);
    kernel.noise *= std::exp(noise.step(Eigen::ArrayXd::Constant(1, by.noise), step, share)[0]);
    context.progress(static_cast<double>(step) / learning.steps);
  }
  return kernel;
}

}  // namespace talkgraph
