#include "nodes/smooth/register.h"

#include "nodes/smooth/emphasise.h"
#include "nodes/smooth/lowpass.h"
#include "nodes/smooth/lowpass_online.h"

namespace talkgraph {

void register_smooth(Registry& registry) {
  registry.add<Emphasise>();
  registry.add<Lowpass>();
  registry.add<LowpassOnline>();
}

}  // namespace talkgraph
