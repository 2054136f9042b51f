#include "nodes/latent/gpdm.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/latent/linear_models.h"

namespace talkgraph {

namespace {

struct Sequences {
  Eigen::MatrixXd frames;
  std::vector<std::int64_t> lengths;
};

Sequences measured(const Collected<Track>& tracks) {
  Sequences s;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    if (track.frames() == 0) continue;
    if (s.frames.rows() > 0 && track.dimension() != s.frames.cols())
      throw std::runtime_error(
          fmt::format("track \"{}\" has {} dimensions, those before it {}: train all on the same "
                      "features",
                      tracks.key(i), track.dimension(), s.frames.cols()));
    if (!track.values.allFinite())
      throw std::runtime_error("track \"" + tracks.key(i) + "\" has a value that is not finite");
    bool goes_on = false;
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      const bool lost = track.is_lost(t);
      if (!lost && goes_on) ++s.lengths.back();
      if (!lost && !goes_on) s.lengths.push_back(1);
      goes_on = !lost;
    }
    const Eigen::Index had = s.frames.rows(), lost = static_cast<Eigen::Index>(track.lost.size());
    s.frames.conservativeResize(had + track.frames() - lost, track.dimension());
    Eigen::Index row = had;
    for (Eigen::Index t = 0; t < track.frames(); ++t)
      if (!track.is_lost(t)) s.frames.row(row++) = track.values.row(t);
  }
  if (s.frames.rows() == 0 || s.frames.cols() == 0)
    throw std::runtime_error("the tracks have no measured frame to train on");
  return s;
}

}  // namespace

TrainGpdm::TrainGpdm() {
  latent_dimension = 2;
  iterations = 200;
  first_variance = 1;
  prior_deviation = 0;
  hold_noise = 20;
}

Gpdm TrainGpdm::operator()(const Collected<Track>& tracks, Context& context) const {
  Sequences data = measured(tracks);
  const auto start = [](const std::vector<Eigen::MatrixXd>& scaled, Eigen::Index d) {
    return fit_ppca(scaled[0], d).posterior_mean(scaled[0]);
  };
  TrainedLatents trained =
      train_latents(*this, "GPDM", {{"observations", std::move(data.frames), scaling}}, data.lengths, start, context);
  Gpdm model;
  model.latents = std::move(trained.latents);
  model.lengths = std::move(data.lengths);
  model.names = tracks[0].names;
  model.observations = std::move(trained.processes[0]);
  model.dynamics = std::move(trained.dynamics);
  model.form = dynamics == LatentDynamics::difference ? DynamicsForm::difference : DynamicsForm::absolute;
  model.back_constraint = std::move(trained.back_constraint);
  model.dynamics_bias = trained.dynamics_weight;
  model.first_variance = trained.first_variance;
  model.log_likelihood = -trained.report.cost;
  model.jitter = trained.jitter;
  for (const double cost : trained.report.trace) model.trace.push_back(-cost);
  return model;
}

void describe(Description<TrainGpdm>& d) {
  d.type("latent.gpdm").version(1).stored();
  d.summary("trains a Gaussian process dynamical model of one stream of tracks, or a GPLVM");
  d.source("Thesis §4.2.4-4.2.5, Eqns 4.34-4.46, corrected as in docs/method.md §4");
  d.input("tracks", "one track a sequence").output("model", "the process of one latent trajectory");
  d.param("scaling", &TrainGpdm::scaling)
      .doc("per_dimension gives every dimension the same weight; common keeps the ratios of their variances");
  describe_training(d);
}

}  // namespace talkgraph
