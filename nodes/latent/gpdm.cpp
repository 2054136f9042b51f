#include "nodes/latent/gpdm.h"

#include "nodes/latent/linear_models.h"
#include "nodes/latent/sequences.h"

namespace talkgraph {

TrainGpdm::TrainGpdm() {
  latent_dimension = 2;
  iterations = 200;
  first_variance = 1;
  prior_deviation = 0;
  hold_noise = 20;
}

Gpdm TrainGpdm::operator()(const Collected<Track>& tracks, Context& context) const {
  Sequences data = measured_runs(tracks);
  const auto start = [](const std::vector<Eigen::MatrixXd>& scaled, Eigen::Index d) {
    return fit_ppca(scaled[0], d).posterior_mean(scaled[0]);
  };
  TrainedLatents trained =
      train_latents(*this, "GPDM", {{"observations", std::move(data.frames), scaling}}, data.lengths, start, context);
  Gpdm model;
  model.lengths = std::move(data.lengths);
  model.names = tracks[0].names;
  model.observations = std::move(trained.processes[0]);
  trained.move_to(model);
  return model;
}

void describe(Description<TrainGpdm>& d) {
  d.type("latent.gpdm").version(3).stored();
  d.summary("trains a Gaussian process dynamical model of one stream of tracks, or a GPLVM");
  d.source("Thesis §4.2.4-4.2.5, Eqns 4.34-4.46, corrected as in docs/method.md §4");
  d.input("tracks", "one track a sequence").output("model", "the process of one latent trajectory");
  d.param("scaling", &TrainGpdm::scaling)
      .doc("per_dimension gives every dimension the same weight; common keeps the ratios of their variances");
  describe_training(d);
}

}  // namespace talkgraph
