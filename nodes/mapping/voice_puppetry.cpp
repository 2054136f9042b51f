#include "nodes/mapping/voice_puppetry.h"

#include "nodes/latent/em.h"
#include "nodes/latent/entropic_hmm.h"
#include "nodes/latent/gmm.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/trajectory.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

/// A Gaussian a state, of the sound of its frames.
std::vector<GaussianMixture> remapped(const Eigen::MatrixXd& audio, const Eigen::MatrixXd& occupancies, double floor,
                                      CovarianceKind kind) {
  const Eigen::VectorXd floors = variance_floors(audio, floor);
  GaussianMixture all{Eigen::VectorXd::Ones(1), Eigen::MatrixXd(1, audio.cols()), {{}}};
  maximise(all, audio, Eigen::VectorXd::Ones(audio.rows()), floors, kind);
  std::vector<GaussianMixture> states(static_cast<std::size_t>(occupancies.cols()), all);
  maximise(states, audio, occupancies, floors, kind);
  return states;
}

}  // namespace

VoicePuppetry TrainVoicePuppetry::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                                             Random& random, Context& context) const {
  const JoinedStreams both = side_by_side(audio, visual);
  const Sequences data = measured_runs(both.tracks);
  const auto heard = data.frames.leftCols(both.audio), seen = data.frames.rightCols(data.frames.cols() - both.audio);
  VoicePuppetry model{scaling_of(heard), scaling_of(seen), {}, {}};
  const Sequences moving{with_changes({scaled(model.visual, seen), data.lengths}, 1), data.lengths};
  model.states = EntropicHmm{states, prior, covariance, floor, iterations, tolerance}.fit(moving, random, context);
  HmmExpectations given;
  expect(model.states, moving, given);
  model.sounds = remapped(scaled(model.audio, heard), given.states, floor, covariance);
  return model;
}

void describe(Description<TrainVoicePuppetry>& d) {
  d.type("mapping.voice_puppetry").version(2).stored();
  d.summary("learns an entropic hidden Markov model of the face, and what its states sound like");
  d.source("Thesis §4.2.3, Eqns 4.11-4.12; Brand 1999, \"Voice puppetry\"");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "states of the face and their sound");
  d.param("states", &TrainVoicePuppetry::states).at_least(1).doc("fewer if there are fewer distinct frames");
  d.param("prior", &TrainVoicePuppetry::prior)
      .at_least(0)
      .doc("weight of the entropies in training; 1 is Brand's, 0 gives maximum likelihood");
  d.param("covariance", &TrainVoicePuppetry::covariance).doc("of face and sound: full, or variances only");
  describe_em(d, "a Gaussian");
}

}  // namespace talkgraph
