#include "nodes/types/context_gp.h"

namespace talkgraph {

void fields(Archive& ar, ContextGp& g) {
  ar("audio_mean", g.audio_mean);
  ar("audio_scale", g.audio_scale);
  ar("phones", g.phones);
  ar("phone_scale", g.phone_scale);
  ar("window", g.window);
  ar("lengths", g.lengths);
  ar("frames", g.frames);
  ar("weights", g.weights);
  ar("mean", g.mean);
  ar("signal", g.signal);
  ar("noise", g.noise);
  ar("inducing", g.inducing);
  ar("certainty", g.certainty);
}

}  // namespace talkgraph
