#include "nodes/mapping/voice_puppetry_synthesise.h"

#include "nodes/latent/hmm.h"
#include "nodes/latent/trajectory.h"
#include "nodes/mapping/scaling.h"

namespace talkgraph {

namespace {

TrajectoryStates trajectory_states(const std::vector<GaussianMixture>& states) {
  TrajectoryStates all{Eigen::MatrixXd(std::ssize(states), states.at(0).dimension()), {}, 1};
  for (const GaussianMixture& state : states) {
    all.means.row(std::ssize(all.covariances)) = state.means;
    all.covariances.push_back(state.covariances[0]);
  }
  return all;
}

}  // namespace

Track SynthesiseVoicePuppetry::operator()(const VoicePuppetry& model, const Track& audio) const {
  Track visual{Eigen::MatrixXd(0, model.visual.mean.size()), audio.rate, audio.start, {}};
  if (audio.frames() == 0) return visual;
  require_frames_of(audio, model.audio.mean.size(), "voice puppetry");
  Eigen::MatrixXd densities = log_densities(model.sounds, scaled(model.audio, audio.values));
  for (const Eigen::Index t : audio.lost) densities.row(t).setZero();
  const ChainPath path = viterbi(chain_of(model.states), densities);
  visual.values =
      restored(model.visual, likeliest_trajectory(trajectory_states(model.states.observations), path.states));
  return visual;
}

void describe(Description<SynthesiseVoicePuppetry>& d) {
  d.type("mapping.voice_puppetry_synthesise").version(1);
  d.summary("visual features of new speech by voice puppetry");
  d.source("Thesis §4.2.3; Brand 1999, \"Voice puppetry\"");
  d.input("model", "of mapping.voice_puppetry")
      .input("audio", "speech features at the video rate")
      .output("visual", "visual parameters, a frame for each of the sound's");
}

}  // namespace talkgraph
