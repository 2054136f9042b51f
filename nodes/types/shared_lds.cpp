#include "nodes/types/shared_lds.h"

namespace talkgraph {

void fields(Archive& ar, SharedLds& s) {
  ar("audio", s.audio);
  ar("visual", s.visual);
  ar("system", s.system);
}

}  // namespace talkgraph
