#include "nodes/latent/coupled_hmm.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/latent/em.h"
#include "nodes/latent/gmm.h"

namespace talkgraph {

namespace {

/// Densities as shares of the frame's largest.
Eigen::MatrixXd relative(const Eigen::MatrixXd& logs) {
  return (logs.colwise() - logs.rowwise().maxCoeff()).unaryExpr([](double x) { return std::exp(x); });
}

/// p(pair of states | frames up to t), K_Y K_Z × T, and what each frame was divided by.
struct Forward {
  Eigen::MatrixXd pairs;
  Eigen::VectorXd scales;
};

Forward forward(const CoupledChain& audio, const CoupledChain& visual, const Eigen::MatrixXd& heard,
                const Eigen::MatrixXd& seen) {
  Forward f{{audio.states() * visual.states(), heard.rows()}, Eigen::VectorXd(heard.rows())};
  for (Eigen::Index t = 0; t < heard.rows(); ++t) {
    Eigen::MatrixXd pairs = audio.start * visual.start.transpose();
    if (t > 0) pairs.noalias() = audio.transitions.transpose() * (f.pairs.col(t - 1).asDiagonal() * visual.transitions);
    pairs = heard.row(t).asDiagonal() * pairs * seen.row(t).asDiagonal();
    f.scales(t) = pairs.sum();
    if (!(f.scales(t) > 0))
      throw std::runtime_error(
          fmt::format("no path of the coupled hidden Markov model explains frame {} and those before it", t));
    f.pairs.col(t) = pairs.reshaped() / f.scales(t);
  }
  return f;
}

/// Adds what one sequence gives from row `from` on.
void backward(const CoupledChain& audio, const CoupledChain& visual, const Eigen::MatrixXd& heard,
              const Eigen::MatrixXd& seen, const Forward& f, Eigen::Index from, CoupledExpectations& e) {
  const Eigen::Index rows = audio.states(), cols = visual.states();
  Eigen::MatrixXd after = Eigen::MatrixXd::Ones(rows, cols);
  for (Eigen::Index t = heard.rows() - 1;; --t) {
    const Eigen::MatrixXd pairs = f.pairs.col(t).reshaped(rows, cols).cwiseProduct(after);
    e.audio.states.row(from + t) = pairs.rowwise().sum().transpose();
    e.visual.states.row(from + t) = pairs.colwise().sum();
    if (t == 0) break;
    const Eigen::MatrixXd next = heard.row(t).asDiagonal() * after * seen.row(t).asDiagonal() / f.scales(t);
    const Eigen::MatrixXd to_audio = audio.transitions.cwiseProduct(visual.transitions * next.transpose());
    const Eigen::MatrixXd to_visual = visual.transitions.cwiseProduct(audio.transitions * next);
    e.audio.steps += f.pairs.col(t - 1).asDiagonal() * to_audio;
    e.visual.steps += f.pairs.col(t - 1).asDiagonal() * to_visual;
    after = to_audio.rowwise().sum().reshaped(rows, cols);
  }
  e.audio.starts += e.audio.states.row(from).transpose();
  e.visual.starts += e.visual.states.row(from).transpose();
}

void clear(HmmExpectations& e, const CoupledChain& chain, Eigen::Index frames) {
  e.states.resize(frames, chain.states());
  e.starts.setZero(chain.states());
  e.steps.setZero(chain.transitions.rows(), chain.states());
}

/// Every row as often as that, one after the other.
Eigen::MatrixXd repeated(const Eigen::MatrixXd& rows, Eigen::Index times) {
  return rows(Eigen::ArrayXi::NullaryExpr(rows.rows() * times, [times](Eigen::Index i) { return i / times; }),
              Eigen::all);
}

double log_prior(const CoupledChain& chain, double prior) {
  return prior * (chain.start.array().log().sum() + chain.transitions.array().log().sum());
}

void maximise(CoupledChain& chain, const Eigen::MatrixXd& frames, const HmmExpectations& e, double prior,
              const Eigen::VectorXd& floors, CovarianceKind kind) {
  const Eigen::MatrixXd steps = e.steps.array() + prior;
  chain.start = e.starts.array() + prior;
  chain.start /= chain.start.sum();
  chain.transitions = steps.rowwise().sum().cwiseInverse().asDiagonal() * steps;
  maximise(chain.observations, frames, e.states, floors, kind);
}

/// The frames that are likeliest given the states' probabilities and, of states that are mixtures, the frames before:
/// (Σ γ Σ_k⁻¹)⁻¹ Σ γ Σ_k⁻¹ μ_k.
Eigen::MatrixXd likeliest_frames(const std::vector<GaussianMixture>& states, const Eigen::MatrixXd& occupancies,
                                 const Eigen::MatrixXd& before) {
  const Eigen::Index dims = states.at(0).dimension(), frames = occupancies.rows();
  std::vector<Eigen::MatrixXd> precisions(static_cast<std::size_t>(frames), Eigen::MatrixXd::Zero(dims, dims));
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(dims, frames);
  for (Eigen::Index k = 0; k < std::ssize(states); ++k) {
    const GaussianMixture& state = states[static_cast<std::size_t>(k)];
    const Eigen::MatrixXd shares =
        before.rows() > 0 ? responsibilities(state, before) : state.weights.transpose().replicate(frames, 1);
    for (Eigen::Index c = 0; c < state.components(); ++c) {
      const Eigen::MatrixXd inverse = precision(state.covariances[static_cast<std::size_t>(c)]);
      const Eigen::VectorXd pull = inverse * state.means.row(c).transpose();
      for (Eigen::Index t = 0; t < frames; ++t) {
        const double weight = occupancies(t, k) * shares(t, c);
        precisions[static_cast<std::size_t>(t)] += weight * inverse;
        pulls.col(t) += weight * pull;
      }
    }
  }
  Eigen::MatrixXd likeliest(frames, dims);
  for (Eigen::Index t = 0; t < frames; ++t)
    likeliest.row(t) = precisions[static_cast<std::size_t>(t)].llt().solve(pulls.col(t)).transpose();
  return likeliest;
}

}  // namespace

double expect(const CoupledChain& audio, const CoupledChain& visual, const Eigen::MatrixXd& audio_densities,
              const Eigen::MatrixXd& visual_densities, const std::vector<std::int64_t>& lengths,
              CoupledExpectations& e) {
  const Eigen::MatrixXd heard = relative(audio_densities), seen = relative(visual_densities);
  clear(e.audio, audio, heard.rows());
  clear(e.visual, visual, heard.rows());
  double log_likelihood = (audio_densities.rowwise().maxCoeff() + visual_densities.rowwise().maxCoeff()).sum();
  Eigen::Index from = 0;
  for (const Eigen::Index length : lengths) {
    const Eigen::MatrixXd heard_here = heard.middleRows(from, length), seen_here = seen.middleRows(from, length);
    const Forward f = forward(audio, visual, heard_here, seen_here);
    backward(audio, visual, heard_here, seen_here, f, from, e);
    log_likelihood += f.scales.array().log().sum();
    from += length;
  }
  return log_likelihood;
}

void FitCoupledHmm::operator()(const Eigen::MatrixXd& audio, const Eigen::MatrixXd& visual,
                               const std::vector<std::int64_t>& lengths, CoupledHmm& model, Random& random,
                               Context& context) const {
  const Eigen::VectorXd audio_floors = variance_floors(audio, floor), visual_floors = variance_floors(visual, floor);
  const auto start = [&](int states, const Eigen::MatrixXd& frames) {
    return TrainHmm{states, mixture, covariance, floor, 0}.fit({frames, lengths}, random, context);
  };
  Hmm of_sound = start(audio_states, audio), of_face = start(visual_states, visual);
  const Eigen::Index sounds = of_sound.states(), faces = of_face.states();
  model.audio = {of_sound.start, of_sound.transitions.replicate(faces, 1), of_sound.observations};
  model.visual = {of_face.start, repeated(of_face.transitions, sounds), of_face.observations};
  CoupledExpectations given;
  const auto objective = [&] {
    return expect(model.audio, model.visual, log_densities(model.audio.observations, audio),
                  log_densities(model.visual.observations, visual), lengths, given) +
           log_prior(model.audio, prior) + log_prior(model.visual, prior);
  };
  const auto improve = [&] {
    maximise(model.audio, audio, given.audio, prior, audio_floors, covariance);
    maximise(model.visual, visual, given.visual, prior, visual_floors, covariance);
  };
  model.trace = run_em({iterations, tolerance, "log-posterior"}, audio.rows(),
                       fmt::format("coupled HMM of {} × {} states", sounds, faces), context, objective, improve);
}

Inversion invert(const CoupledHmm& model, const Eigen::MatrixXd& audio, const std::vector<std::int64_t>& lost,
                 int iterations) {
  Eigen::MatrixXd heard = log_densities(model.audio.observations, audio);
  for (const Eigen::Index t : lost) heard.row(t).setZero();
  CoupledExpectations e;
  const auto given = [&](const Eigen::MatrixXd& seen) {
    return expect(model.audio, model.visual, heard, seen, {audio.rows()}, e);
  };
  given(Eigen::MatrixXd::Zero(audio.rows(), model.visual.states()));
  Inversion inversion{likeliest_frames(model.visual.observations, e.visual.states, {}), {}};
  for (int i = 0;; ++i) {
    inversion.trace.push_back(given(log_densities(model.visual.observations, inversion.frames)));
    if (i == iterations) return inversion;
    inversion.frames = likeliest_frames(model.visual.observations, e.visual.states, inversion.frames);
  }
}

}  // namespace talkgraph
