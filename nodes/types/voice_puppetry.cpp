#include "nodes/types/voice_puppetry.h"

namespace talkgraph {

void fields(Archive& ar, VoicePuppetry& v) {
  ar("audio", v.audio);
  ar("visual", v.visual);
  ar("states", v.states);
  ar("sounds", v.sounds);
}

}  // namespace talkgraph
