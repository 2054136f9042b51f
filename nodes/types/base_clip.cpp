#include "nodes/types/base_clip.h"

namespace talkgraph {

void fields(Archive& ar, BaseClip& b) {
  ar("frames", b.frames);
  ar("track", b.track);
}

}  // namespace talkgraph
