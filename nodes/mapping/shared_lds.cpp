#include "nodes/mapping/shared_lds.h"

#include "nodes/latent/lds.h"
#include "nodes/mapping/paired.h"
#include "nodes/mapping/scaling.h"

namespace talkgraph {

SharedLds TrainSharedLds::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                                     Context& context) const {
  const SideBySide streams = side_by_side(audio, visual);
  Sequences data = measured_runs(streams.tracks);
  const Eigen::Index heard = streams.audio;
  const Scaling both = scaling_of(data.frames);
  data.frames = scaled(both, data.frames);
  TrainLds train;
  train.latent_dimension = latent_dimension;
  train.covariance = covariance;
  train.iterations = iterations;
  train.tolerance = tolerance;
  return {part_of(both, 0, heard), part_of(both, heard, both.mean.size() - heard), train.fit(data, context, heard)};
}

void describe(Description<TrainSharedLds>& d) {
  d.type("mapping.shared_lds").version(1).stored();
  d.summary("learns one linear dynamical system behind sound and face");
  d.source("Thesis §4.3.3, Eqns 4.57-4.64; Lehn-Schiøler, Hansen and Larsen 2005");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "the system");
  d.param("latent_dimension", &TrainSharedLds::latent_dimension).at_least(1).doc("of the state");
  d.param("covariance", &TrainSharedLds::covariance).doc("of the noise of either stream");
  d.param("iterations", &TrainSharedLds::iterations).at_least(0).doc("limit of expectation maximisation");
  d.param("tolerance", &TrainSharedLds::tolerance)
      .at_least(0)
      .doc("it ends when the log-likelihood gains no more than this in an iteration, a frame");
}

}  // namespace talkgraph
