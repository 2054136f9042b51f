#include "nodes/mapping/shared_lds_synthesise.h"

#include "nodes/latent/lds.h"
#include "nodes/mapping/scaling.h"

namespace talkgraph {

Track SynthesiseSharedLds::operator()(const SharedLds& model, const Track& audio) const {
  const Eigen::Index heard = model.audio.mean.size(), seen = model.visual.mean.size();
  Track visual{Eigen::MatrixXd(0, seen), audio.rate, audio.start, {}};
  if (audio.frames() == 0) return visual;
  require_frames_of(audio, heard, "the shared linear dynamical system");
  const Eigen::MatrixXd frames = scaled(model.audio, audio.values);
  const Lds of_sound = observed_part(model.system, 0, heard), of_face = observed_part(model.system, heard, seen);
  const LdsPosterior states =
      smooth ? kalman_smoother(of_sound, frames, audio.lost) : kalman_filter(of_sound, frames, audio.lost);
  visual.values = restored(model.visual, observations(of_face, states.means));
  return visual;
}

void describe(Description<SynthesiseSharedLds>& d) {
  d.type("mapping.shared_lds_synthesise").version(1);
  d.summary("visual features of new speech by a shared linear dynamical system");
  d.source("Thesis §4.3.3; Lehn-Schiøler, Hansen and Larsen 2005; Kalman 1960; Rauch, Tung and Striebel 1965");
  d.input("model", "of mapping.shared_lds")
      .input("audio", "speech features at the video rate")
      .output("visual", "visual parameters, a frame for each of the sound's");
  d.param("smooth", &SynthesiseSharedLds::smooth)
      .doc(
          "states given the whole sound (RTS smoother); otherwise given it up to their frame (Kalman filter), as in "
          "the source");
}

}  // namespace talkgraph
