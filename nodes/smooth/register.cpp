#include "nodes/smooth/register.h"

#include "nodes/smooth/emphasise.h"
#include "nodes/smooth/lowpass.h"

namespace talkgraph {

void register_smooth(Registry& registry) {
  registry.add<Emphasise>();
  registry.add<Lowpass>();
}

}  // namespace talkgraph
