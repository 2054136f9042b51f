#include "nodes/model/talking_face.h"

namespace talkgraph {

void fields(Archive& ar, TalkingFace& f) {
  ar("face", f.face);
  ar("base", f.base);
  ar("contexts", f.contexts);
  ar("states", f.states);
  ar("process", f.process);
  ar("mean", f.mean);
  ar("mouths", f.mouths);
  ar("speak", f.speak);
}

}  // namespace talkgraph
