#include "nodes/types/slds.h"

namespace talkgraph {

void fields(Archive& ar, Slds& s) {
  ar("audio", s.audio);
  ar("visual", s.visual);
  ar("phones", s.phones);
  ar("shared", s.shared);
  ar("trace", s.trace);
}

}  // namespace talkgraph
