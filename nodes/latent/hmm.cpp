#include "nodes/latent/hmm.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "nodes/latent/em.h"
#include "nodes/latent/gmm.h"
#include "nodes/latent/k_means.h"
#include "nodes/types/best_path.h"

namespace talkgraph {

namespace {

constexpr double impossible = -std::numeric_limits<double>::infinity();

/// exp x, without taking the trouble where it is 0.
double exp_or_zero(double x) { return x < -745.2 ? 0 : std::exp(x); }

/// to_j = ln Σ_i exp(from_i + steps_ij).
void log_sum_steps(const Eigen::MatrixXd& steps, const Eigen::VectorXd& from, Eigen::Ref<Eigen::VectorXd> to) {
  for (Eigen::Index j = 0; j < steps.cols(); ++j) {
    const double most = (from + steps.col(j)).maxCoeff();
    if (most == impossible) {
      to(j) = impossible;
      continue;
    }
    double sum = 0;
    for (Eigen::Index i = 0; i < from.size(); ++i) sum += exp_or_zero(from(i) + steps(i, j) - most);
    to(j) = most + std::log(sum);
  }
}

double log_sum(const Eigen::VectorXd& logs) { return log_sum_rows(logs.transpose())(0); }

void require_reachable(const Eigen::VectorXd& scores, Eigen::Index t) {
  if (!(scores.maxCoeff() > impossible))
    throw std::runtime_error(fmt::format(
        "no path of the hidden Markov model explains frame {} and those before it: the frame is too far from "
        "the states that can be reached",
        t));
}

/// Logarithms keep their places however long a sequence is, as each frame is divided by p(y_t | y_1..y_{t−1}).
struct Forward {
  Eigen::MatrixXd scores;  ///< ln p(π_t | y_1..y_t), K × T
  Eigen::VectorXd scales;  ///< ln p(y_t | y_1..y_{t−1}), T
};

Forward forward(const MarkovChain& chain, const Eigen::MatrixXd& log_densities) {
  Forward f{{log_densities.cols(), log_densities.rows()}, Eigen::VectorXd(log_densities.rows())};
  for (Eigen::Index t = 0; t < f.scores.cols(); ++t) {
    Eigen::VectorXd score = chain.log_start;
    if (t > 0) log_sum_steps(chain.log_transitions, f.scores.col(t - 1), score);
    score += log_densities.row(t).transpose();
    require_reachable(score, t);
    f.scales(t) = log_sum(score);
    f.scores.col(t) = score.array() - f.scales(t);
  }
  return f;
}

/// ln p(y_{t+1}..y_T | π_t) − ln p(y_{t+1}..y_T | y_1..y_t), K × T.
Eigen::MatrixXd backward(const MarkovChain& chain, const Eigen::MatrixXd& log_densities,
                         const Eigen::VectorXd& scales) {
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(log_densities.cols(), log_densities.rows());
  const Eigen::MatrixXd back = chain.log_transitions.transpose();
  for (Eigen::Index t = scores.cols() - 2; t >= 0; --t) {
    const Eigen::VectorXd after = scores.col(t + 1) + log_densities.row(t + 1).transpose();
    log_sum_steps(back, after, scores.col(t));
    scores.col(t).array() -= scales(t + 1);
  }
  return scores;
}

Eigen::Index components(const Hmm& model) {
  Eigen::Index most = 0;
  for (const GaussianMixture& m : model.observations) most = std::max(most, m.components());
  return most;
}

/// Rows of the frames that are in a cluster.
Eigen::MatrixXd members(const Eigen::MatrixXd& frames, const Eigen::VectorXd& in) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(in.sum()), frames.cols());
  for (Eigen::Index n = 0, row = 0; n < frames.rows(); ++n)
    if (in(n) > 0) rows.row(row++) = frames.row(n);
  return rows;
}

Eigen::MatrixXd normalised_rows(const Eigen::MatrixXd& counts) {
  return counts.rowwise().sum().cwiseInverse().asDiagonal() * counts;
}

Hmm start_hmm(const Sequences& data, const TrainHmm& options, const Eigen::VectorXd& floors, Random& random) {
  const Eigen::MatrixXd in =
      k_means(data.frames * floors.cwiseSqrt().cwiseInverse().asDiagonal(), options.states, random);
  const Eigen::Index states = in.cols();
  Eigen::VectorXd starts = Eigen::VectorXd::Ones(states);
  Eigen::MatrixXd steps = Eigen::MatrixXd::Ones(states, states);
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    starts += in.row(from).transpose();
    steps += in.middleRows(from, length - 1).transpose() * in.middleRows(from + 1, length - 1);
    from += length;
  }
  Hmm model{starts / starts.sum(), normalised_rows(steps), {}, {}};
  for (Eigen::Index k = 0; k < states; ++k)
    model.observations.push_back(
        start_mixture(members(data.frames, in.col(k)), options.mixture, floors, options.covariance, random));
  return model;
}

void maximise(Hmm& model, const Sequences& data, const HmmExpectations& e, const Eigen::VectorXd& floors,
              CovarianceKind kind) {
  model.start = e.starts / e.starts.sum();
  for (Eigen::Index k = 0; k < model.states(); ++k)
    if (const double left = e.steps.row(k).sum(); left > 1e-12) model.transitions.row(k) = e.steps.row(k) / left;
  maximise(model.observations, data.frames, e.states, floors, kind);
}

}  // namespace

MarkovChain chain_of(const Hmm& model) {
  const auto log = [](double p) { return std::log(p); };
  return {model.start.unaryExpr(log), model.transitions.unaryExpr(log)};
}

Eigen::MatrixXd log_densities(const std::vector<GaussianMixture>& states, const Eigen::MatrixXd& frames) {
  Eigen::MatrixXd logs(frames.rows(), std::ssize(states));
  for (Eigen::Index k = 0; k < logs.cols(); ++k)
    logs.col(k) = log_likelihood(states[static_cast<std::size_t>(k)], frames);
  return logs;
}

ChainPosterior forward_backward(const MarkovChain& chain, const Eigen::MatrixXd& log_densities) {
  const Eigen::Index states = log_densities.cols();
  const Forward f = forward(chain, log_densities);
  const Eigen::MatrixXd after = backward(chain, log_densities, f.scales);
  ChainPosterior p{{}, Eigen::MatrixXd::Zero(states, states), f.scales.sum()};
  for (Eigen::Index t = 1; t < log_densities.rows(); ++t) {
    const Eigen::VectorXd next = (after.col(t) + log_densities.row(t).transpose()).array() - f.scales(t);
    for (Eigen::Index k = 0; k < states; ++k)
      for (Eigen::Index j = 0; j < states; ++j)
        p.steps(j, k) += exp_or_zero(f.scores(j, t - 1) + chain.log_transitions(j, k) + next(k));
  }
  p.states = normalised_rows((f.scores + after).unaryExpr(&exp_or_zero).transpose());
  return p;
}

ChainPath viterbi(const MarkovChain& chain, const Eigen::MatrixXd& log_densities) {
  const auto scores = [&](Eigen::Index t) -> Eigen::VectorXd {
    if (t == 0) return chain.log_start + log_densities.row(0).transpose();
    return log_densities.row(t);
  };
  BestPath best = best_path(log_densities.rows(), scores,
                            [&](Eigen::Index) -> const Eigen::MatrixXd& { return chain.log_transitions; });
  for (std::size_t t = 0; t < best.scores.size(); ++t) require_reachable(best.scores[t], static_cast<Eigen::Index>(t));
  return {std::move(best.states), best.scores.back().maxCoeff()};
}

double expect(const Hmm& model, const Sequences& data, HmmExpectations& e) {
  const MarkovChain chain = chain_of(model);
  const Eigen::MatrixXd densities = log_densities(model, data.frames);
  e.states.resize(densities.rows(), densities.cols());
  e.starts.setZero(model.states());
  e.steps.setZero(model.states(), model.states());
  double log_likelihood = 0;
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    const ChainPosterior p = forward_backward(chain, densities.middleRows(from, length));
    e.states.middleRows(from, length) = p.states;
    e.starts += p.states.row(0).transpose();
    e.steps += p.steps;
    log_likelihood += p.log_likelihood;
    from += length;
  }
  return log_likelihood;
}

void maximise(std::vector<GaussianMixture>& states, const Eigen::MatrixXd& frames, const Eigen::MatrixXd& occupancies,
              const Eigen::VectorXd& floors, CovarianceKind kind) {
  for (Eigen::Index k = 0; k < occupancies.cols(); ++k) {
    GaussianMixture& state = states[static_cast<std::size_t>(k)];
    if (state.components() == 1)
      maximise(state, frames, occupancies.col(k), floors, kind);
    else
      maximise(state, frames, occupancies.col(k).asDiagonal() * responsibilities(state, frames), floors, kind);
  }
}

Hmm TrainHmm::fit(const Sequences& data, Random& random, Context& context) const {
  const Eigen::VectorXd floors = variance_floors(data.frames, floor);
  Hmm model = start_hmm(data, *this, floors, random);
  HmmExpectations given;
  model.trace = run_em(
      {iterations, tolerance}, data.frames.rows(),
      fmt::format("HMM of {} states, {} components each at most", model.states(), components(model)), context,
      [&] { return expect(model, data, given); }, [&] { maximise(model, data, given, floors, covariance); });
  return model;
}

Hmm TrainHmm::operator()(const Collected<Track>& tracks, Random& random, Context& context) const {
  return fit(measured_runs(tracks), random, context);
}

void describe(Description<TrainHmm>& d) {
  d.type("latent.hmm").version(2).stored();
  d.summary("trains a hidden Markov model with Gaussians or their mixtures on tracks");
  d.source("Thesis §4.2.3, Eqn 4.9; Baum-Welch from k-means");
  d.input("tracks", "every run of measured frames is a sequence").output("model", "start, transitions and mixtures");
  d.param("states", &TrainHmm::states).at_least(1).doc("fewer if there are fewer distinct frames");
  d.param("mixture", &TrainHmm::mixture).at_least(1).doc("Gaussians of each state");
  d.param("covariance", &TrainHmm::covariance).doc("full, or variances only");
  describe_em(d, "a Gaussian");
}

DecodeHmm::Out DecodeHmm::operator()(const Hmm& model, const Track& track, Context& context) const {
  require_frames_of(track, model.observations.at(0).dimension(), "the hidden Markov model");
  Out out{{{}, track.rate}, {Eigen::MatrixXd(0, model.states()), track.rate, track.start, {}, track.lost}};
  if (track.frames() == 0) return out;
  Eigen::MatrixXd densities = log_densities(model, track.values);
  for (const Eigen::Index t : track.lost) densities.row(t).setZero();
  const MarkovChain chain = chain_of(model);
  ChainPosterior posterior = forward_backward(chain, densities);
  for (const Eigen::Index state : viterbi(chain, densities).states) out.labels.labels.push_back(std::to_string(state));
  out.posteriors.values = std::move(posterior.states);
  context.log(fmt::format("log-likelihood {:.8g}, {:.5g} a frame", posterior.log_likelihood,
                          posterior.log_likelihood / static_cast<double>(track.frames())));
  return out;
}

void describe(Description<DecodeHmm>& d) {
  d.type("latent.hmm_decode").version(1);
  d.summary("the likeliest path of a track through a hidden Markov model, and each frame's probabilities");
  d.source("Thesis §4.2.3, Algorithm 2 and Eqn 4.10, corrected as in docs/method.md §3");
  d.input("model", "trained on features of this kind").input("track", "of the features that the model was trained on");
  d.output("labels", &DecodeHmm::Out::labels, "a state a frame: 0, 1, ... its row in the model");
  d.output("posteriors", &DecodeHmm::Out::posteriors, "T × K, rows sum to 1");
}

}  // namespace talkgraph
