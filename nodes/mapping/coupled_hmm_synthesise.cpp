#include "nodes/mapping/coupled_hmm_synthesise.h"

#include "nodes/latent/coupled_hmm.h"
#include "nodes/latent/trajectory.h"
#include "nodes/mapping/scaling.h"

namespace talkgraph {

Track SynthesiseCoupledHmm::operator()(const CoupledHmm& model, const Track& audio) const {
  Track visual{Eigen::MatrixXd(0, model.visual_scaling.mean.size()), audio.rate, audio.start, {}};
  if (audio.frames() == 0) return visual;
  require_frames_of(audio, model.audio_scaling.mean.size() / (1 + model.changes), "the coupled hidden Markov model");
  const Eigen::MatrixXd heard = with_changes({audio.values, {audio.frames()}}, model.changes);
  visual.values =
      restored(model.visual_scaling, invert(model, scaled(model.audio_scaling, heard), audio.lost, iterations).frames);
  return visual;
}

void describe(Description<SynthesiseCoupledHmm>& d) {
  d.type("mapping.coupled_hmm_synthesise").version(1);
  d.summary("visual features of new speech by inversion of a coupled hidden Markov model");
  d.source("Thesis §4.3.2; Xie and Liu 2007; Choi, Luo and Hwang 2001");
  d.input("model", "of mapping.coupled_hmm")
      .input("audio", "speech features at the video rate")
      .output("visual", "visual parameters, a frame for each of the sound's");
  d.param("iterations", &SynthesiseCoupledHmm::iterations)
      .at_least(0)
      .doc("of expectation maximisation; 0: the face of the states that the sound alone makes likely");
}

}  // namespace talkgraph
