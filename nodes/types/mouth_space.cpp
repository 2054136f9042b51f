#include "nodes/types/mouth_space.h"

namespace talkgraph {

void fields(Archive& ar, MouthSpace& m) {
  ar("reference", m.reference);
  ar("mouth", m.mouth);
  ar("mean", m.mean, "pixel");
  ar("modes", m.modes);
}

}  // namespace talkgraph
