#include "nodes/latent/log_likelihood.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "nodes/latent/gmm.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/lds.h"
#include "nodes/latent/sequences.h"
#include "nodes/types/ppca.h"

namespace talkgraph {

namespace {

double log_likelihood_of(const Value& model, const Track& track) {
  const PortType type = model ? model.type().type : PortType{"nothing", 0};
  const auto check = [&](Eigen::Index dimension) { require_frames_of(track, dimension, "the model"); };
  if (type == port_type<Ppca>) {
    const Ppca& ppca = model.get<Ppca>();
    check(ppca.mean.size());
    return ppca.log_likelihood(measured_runs({{"", track}}).frames).sum();
  }
  if (type == port_type<Gmm>) {
    const GaussianMixture& mixture = model.get<Gmm>().mixture;
    check(mixture.dimension());
    return log_likelihood(mixture, measured_runs({{"", track}}).frames).sum();
  }
  if (type == port_type<Hmm>) {
    const Hmm& hmm = model.get<Hmm>();
    check(hmm.observations.at(0).dimension());
    Eigen::MatrixXd densities = log_densities(hmm, track.values);
    for (const Eigen::Index t : track.lost) densities.row(t).setZero();
    return forward_backward(chain_of(hmm), densities).log_likelihood;
  }
  if (type == port_type<Lds>) {
    const Lds& lds = model.get<Lds>();
    check(lds.dimension());
    return kalman_filter(lds, track.values, track.lost).log_likelihood;
  }
  throw std::runtime_error(
      fmt::format("{} has no density of tracks: wire a model of type Ppca, Gmm, Hmm or Lds", type.name));
}

}  // namespace

std::optional<Scores> LogLikelihood::operator()(const Value& model, const Track& track) const {
  const Eigen::Index frames = track.frames() - std::ssize(track.lost);
  if (frames == 0) return std::nullopt;
  const double share = log_likelihood_of(model, track) / static_cast<double>(frames);
  if (!std::isfinite(share))
    throw std::runtime_error(fmt::format("the log-likelihood is {}: are values of the features huge?", share));
  return Scores{{{"log_likelihood", share}}};
}

void describe(Description<LogLikelihood>& d) {
  d.type("latent.log_likelihood").version(1);
  d.summary("how likely a track is under principal components, a mixture, a hidden Markov model or a linear system");
  d.source("the model's density, a frame");
  d.input("model", "of type Ppca, Gmm, Hmm or Lds").input("track", "of the features that the model was trained on");
  d.output("scores", "log_likelihood: natural logarithm a measured frame");
}

}  // namespace talkgraph
