#include "nodes/mapping/shared_lds.h"

#include "nodes/latent/em.h"
#include "nodes/latent/lds.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

SharedLds TrainSharedLds::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                                     Context& context) const {
  const JoinedStreams streams = side_by_side(audio, visual);
  Sequences data = measured_runs(streams.tracks);
  const Eigen::Index heard = streams.audio;
  const Scaling both = scaling_of(data.frames);
  data.frames = scaled(both, data.frames);
  TrainLds train;
  train.latent_dimension = latent_dimension;
  train.covariance = covariance;
  train.floor = floor;
  train.iterations = iterations;
  train.tolerance = tolerance;
  auto [of_sound, of_face] = split(both, heard);
  return {std::move(of_sound), std::move(of_face), train.fit(data, context, {.apart = heard})};
}

void describe(Description<TrainSharedLds>& d) {
  d.type("mapping.shared_lds").version(2).stored();
  d.summary("learns one linear dynamical system behind sound and face");
  d.source("Thesis §4.3.3, Eqns 4.57-4.64; Lehn-Schiøler, Hansen and Larsen 2005");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "the system");
  d.param("latent_dimension", &TrainSharedLds::latent_dimension).at_least(1).doc("of the state");
  d.param("covariance", &TrainSharedLds::covariance).doc("of the noise of either stream");
  describe_em(d, "either stream's noise");
}

}  // namespace talkgraph
