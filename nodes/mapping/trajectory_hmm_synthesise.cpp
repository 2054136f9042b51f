#include "nodes/mapping/trajectory_hmm_synthesise.h"

#include "nodes/latent/sequences.h"
#include "nodes/mapping/scaling.h"
#include "nodes/mapping/trajectory_hmm.h"
#include "nodes/types/paired.h"

namespace talkgraph {

Track SynthesiseTrajectoryHmm::operator()(const TrajectoryHmm& model, const Track& audio,
                                          const FrameLabels& labels) const {
  require_frames_of(audio, model.audio.mean.size(), "the trajectory HMM");
  const Eigen::Index frames =
      common_frames("the speech", audio.frames(), "audio frames", std::ssize(labels.labels), "labels");
  const StatePath path = path_of(model, scaled(model.audio, audio.values.topRows(frames)),
                                 {labels.labels.begin(), labels.labels.begin() + frames});
  return {restored(model.visual, trajectory(face_of(model), path)), audio.rate, audio.start, {}, {}};
}

void describe(Description<SynthesiseTrajectoryHmm>& d) {
  d.type("mapping.trajectory_hmm_synthesise").version(1);
  d.summary("the likeliest trajectory of visual parameters through the states of phones that sound makes likely");
  d.source("Tokuda, Yoshimura, Masuko, Kobayashi and Kitamura 2000; Zen, Tokuda and Kitamura 2007");
  d.input("model", "of mapping.trajectory_hmm")
      .input("audio", "speech features at the video rate")
      .input("labels", "phones at the video rate")
      .output("visual", "visual parameters");
}

}  // namespace talkgraph
