#include "nodes/types/eyes.h"

namespace talkgraph {

void fields(Archive& ar, Eyes& e) {
  ar("parameters", e.parameters);
  ar("points", e.points);
  ar("nose", e.nose);
}

}  // namespace talkgraph
