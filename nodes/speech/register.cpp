#include "nodes/speech/register.h"

#include "nodes/speech/cepstrum.h"
#include "nodes/speech/deltas.h"
#include "nodes/speech/energy.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/join.h"
#include "nodes/speech/mel.h"
#include "nodes/speech/one_hot.h"
#include "nodes/speech/preemphasis.h"
#include "nodes/speech/spectrum.h"
#include "nodes/speech/stack.h"
#include "nodes/speech/window.h"

namespace talkgraph {

void register_speech(Registry& registry) {
  registry.add<PreEmphasis>();
  registry.add<Frame>();
  registry.add<Window>();
  registry.add<ShortTimeSpectrum>();
  registry.add<Mel>();
  registry.add<Cepstrum>();
  registry.add<Energy>();
  registry.add<Join>();
  registry.add<Stack>();
  registry.add<Deltas>();
  registry.add<OneHot>();
}

}  // namespace talkgraph
