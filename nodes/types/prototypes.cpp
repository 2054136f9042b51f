#include "nodes/types/prototypes.h"

namespace talkgraph {

void fields(Archive& ar, Prototypes& p) {
  ar("images", p.images);
  ar("shapes", p.shapes, "pixel");
  ar("scheme", p.scheme);
}

}  // namespace talkgraph
