#include "nodes/types/windowed_cca.h"

namespace talkgraph {

void fields(Archive& ar, WindowedCca& c) {
  ar("context", c.context);
  ar("audio", c.audio);
  ar("visual", c.visual);
  ar("audio_mean", c.audio_mean);
  ar("visual_mean", c.visual_mean);
  ar("directions", c.directions);
  ar("weights", c.weights);
  ar("correlations", c.correlations);
}

}  // namespace talkgraph
