#include "nodes/mapping/coupled_hmm.h"

#include "nodes/latent/coupled_hmm.h"
#include "nodes/latent/em.h"
#include "nodes/latent/trajectory.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

CoupledHmm TrainCoupledHmm::operator()(const Collected<Track>& audio, const Collected<Track>& visual, Random& random,
                                       Context& context) const {
  const JoinedStreams both = side_by_side(audio, visual);
  const Sequences data = measured_runs(both.tracks);
  const Eigen::MatrixXd heard = with_changes({data.frames.leftCols(both.audio), data.lengths}, changes);
  const Eigen::MatrixXd seen = data.frames.rightCols(data.frames.cols() - both.audio);
  CoupledHmm model{scaling_of(heard), scaling_of(seen), changes, {}, {}, {}};
  const FitCoupledHmm fit{audio_states, visual_states, mixture, covariance, floor, prior, iterations, tolerance};
  fit(scaled(model.audio_scaling, heard), scaled(model.visual_scaling, seen), data.lengths, model, random, context);
  return model;
}

void describe(Description<TrainCoupledHmm>& d) {
  d.type("mapping.coupled_hmm").version(1).stored();
  d.summary("learns a coupled hidden Markov model of sound and face");
  d.source("Thesis §4.3.2, Eqn 4.56 corrected as in docs/method.md; Xie and Liu 2007; Brand, Oliver and Pentland 1997");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "two chains, each of which follows both");
  d.param("audio_states", &TrainCoupledHmm::audio_states)
      .at_least(1)
      .doc("of the sound; time and memory grow with the square of the product of both");
  d.param("visual_states", &TrainCoupledHmm::visual_states).at_least(1).doc("of the face");
  d.param("mixture", &TrainCoupledHmm::mixture).at_least(1).doc("Gaussians of each state");
  d.param("changes", &TrainCoupledHmm::changes)
      .within(0, 2)
      .doc("1: the sound's velocities are beside its frames; 2: its accelerations too");
  d.param("covariance", &TrainCoupledHmm::covariance).doc("of sound and face: full, or variances only");
  d.param("prior", &TrainCoupledHmm::prior).positive().doc("each start and transition is counted this often more");
  describe_em(d, "a Gaussian");
}

}  // namespace talkgraph
