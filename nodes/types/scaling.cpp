#include "nodes/types/scaling.h"

namespace talkgraph {

void fields(Archive& ar, Scaling& s) {
  ar("mean", s.mean);
  ar("deviation", s.deviation);
}

}  // namespace talkgraph
