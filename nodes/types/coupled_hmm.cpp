#include "nodes/types/coupled_hmm.h"

namespace talkgraph {

void fields(Archive& ar, CoupledChain& c) {
  ar("start", c.start);
  ar("transitions", c.transitions);
  ar("observations", c.observations);
}

void fields(Archive& ar, CoupledHmm& c) {
  ar("audio_scaling", c.audio_scaling);
  ar("visual_scaling", c.visual_scaling);
  ar("changes", c.changes);
  ar("audio", c.audio);
  ar("visual", c.visual);
  ar("trace", c.trace);
}

}  // namespace talkgraph
