#include "nodes/smooth/register.h"

#include "nodes/smooth/full_range.h"
#include "nodes/smooth/lowpass.h"
#include "nodes/smooth/lowpass_online.h"

namespace talkgraph {

void register_smooth(Registry& registry) {
  registry.add<FullRange>();
  registry.add<Lowpass>();
  registry.add<LowpassOnline>();
}

}  // namespace talkgraph
