#include "nodes/types/windowed_cca.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const WindowedCca& c) {
  const StoredModel stored("canonical correlations of windows");
  stored.require(c.context >= 0 && c.context <= 50, "context", "is not from 0 to 50");
  const Eigen::Index frames = 2 * c.context + 1, d = c.directions.cols();
  const Eigen::Index heard = frames * c.audio.mean.size(), seen = frames * c.visual.mean.size();
  stored.scaling("audio", c.audio, c.audio.mean.size());
  stored.scaling("visual", c.visual, c.visual.mean.size());
  stored.matrix("audio_mean", c.audio_mean, 1, heard);
  stored.matrix("visual_mean", c.visual_mean, 1, seen);
  stored.matrix("directions", c.directions, heard, d);
  stored.matrix("weights", c.weights, d, seen);
  stored.matrix("correlations", c.correlations, d, 1);
}

}  // namespace

void fields(Archive& ar, WindowedCca& c) {
  ar("context", c.context);
  ar("audio", c.audio);
  ar("visual", c.visual);
  ar("audio_mean", c.audio_mean);
  ar("visual_mean", c.visual_mean);
  ar("directions", c.directions);
  ar("weights", c.weights);
  ar("correlations", c.correlations);
  if (ar.loading()) check(c);
}

}  // namespace talkgraph
