#include "nodes/mapping/slds_synthesise.h"

#include "nodes/latent/lds.h"
#include "nodes/mapping/scaling.h"
#include "nodes/mapping/slds.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

/// The system of every frame.
LdsRegimes regimes_of(const Slds& model, const FrameLabels& labels, Eigen::Index frames) {
  LdsRegimes regimes;
  for (Eigen::Index t = 0; t < frames; ++t)
    regimes.push_back(&system_of(model, labels.labels[static_cast<std::size_t>(t)]));
  return regimes;
}

/// Means of the states of which nothing is observed, T × d.
Eigen::MatrixXd predicted(const LdsRegimes& regimes) {
  Eigen::MatrixXd states(std::ssize(regimes), regimes[0]->states());
  states.row(0) = regimes[0]->first_mean.transpose();
  for (Eigen::Index t = 1; t < states.rows(); ++t) {
    const Lds& system = *regimes[static_cast<std::size_t>(t)];
    states.row(t) = (system.prediction * states.row(t - 1).transpose() + system.offset).transpose();
  }
  return states;
}

/// Means of the states given the sound, T × d.
Eigen::MatrixXd heard(const LdsRegimes& regimes, const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lost,
                      bool smooth) {
  std::map<const Lds*, Lds> of_sound;
  LdsRegimes sound;
  for (const Lds* system : regimes)
    sound.push_back(&of_sound.try_emplace(system, observed_part(*system, 0, frames.cols())).first->second);
  return (smooth ? kalman_smoother(sound, frames, lost) : kalman_filter(sound, frames, lost)).means;
}

}  // namespace

Track SynthesiseSlds::operator()(const Slds& model, const Track& audio, const FrameLabels& labels) const {
  const Eigen::Index dims = model.visual.mean.size(), audio_dims = model.audio.mean.size();
  const Eigen::Index frames =
      common_frames("the speech", audio.frames(), "audio frames", std::ssize(labels.labels), "labels");
  Track visual{Eigen::MatrixXd(frames, dims), audio.rate, audio.start, {}};
  if (frames == 0) return visual;
  const LdsRegimes regimes = regimes_of(model, labels, frames);
  Eigen::MatrixXd states;
  if (audio_dims == 0) {
    states = predicted(regimes);
  } else {
    require_frames_of(audio, audio_dims, "the switching linear dynamical system");
    states = heard(regimes, scaled(model.audio, audio.values.topRows(frames)), audio.lost, smooth);
  }
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Lds& system = *regimes[static_cast<std::size_t>(t)];
    visual.values.row(t) = observations(system, states.row(t)).rightCols(dims);
  }
  visual.values = restored(model.visual, visual.values);
  return visual;
}

void describe(Description<SynthesiseSlds>& d) {
  d.type("mapping.slds_synthesise").version(1);
  d.summary("visual features of new speech by a switching linear dynamical system");
  d.source("Thesis §5.1.1, Eqns 5.7 and 5.8; Kalman 1960; Rauch, Tung and Striebel 1965");
  d.input("model", "of mapping.slds")
      .input("audio", "speech features at the video rate")
      .input("labels", "phones at the video rate")
      .output("visual", "visual parameters");
  d.param("smooth", &SynthesiseSlds::smooth)
      .doc(
          "states given the whole sound (RTS smoother); otherwise given it up to their frame (Kalman filter); of a "
          "system without sound both are Eqn 5.7");
}

}  // namespace talkgraph
