#include "nodes/speech/register.h"

#include "nodes/speech/all_pole.h"
#include "nodes/speech/average.h"
#include "nodes/speech/bark.h"
#include "nodes/speech/cepstrum.h"
#include "nodes/speech/deemphasis.h"
#include "nodes/speech/deltas.h"
#include "nodes/speech/energy.h"
#include "nodes/speech/f0.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/join.h"
#include "nodes/speech/loudness.h"
#include "nodes/speech/lpc.h"
#include "nodes/speech/lsf.h"
#include "nodes/speech/mel.h"
#include "nodes/speech/one_hot.h"
#include "nodes/speech/place.h"
#include "nodes/speech/preemphasis.h"
#include "nodes/speech/rasta.h"
#include "nodes/speech/remove_mean.h"
#include "nodes/speech/residual.h"
#include "nodes/speech/resynthesise.h"
#include "nodes/speech/spectrum.h"
#include "nodes/speech/stack.h"
#include "nodes/speech/window.h"

namespace talkgraph {

void register_speech(Registry& registry) {
  registry.add<Average>();
  registry.add<PreEmphasis>();
  registry.add<Frame>();
  registry.add<RemoveMean>();
  registry.add<FramePreEmphasis>();
  registry.add<Window>();
  registry.add<ShortTimeSpectrum>();
  registry.add<Mel>();
  registry.add<Bark>();
  registry.add<Cepstrum>();
  registry.add<Rasta>();
  registry.add<Loudness>();
  registry.add<AllPole>();
  registry.add<Energy>();
  registry.add<F0>();
  registry.add<Lpc>();
  registry.add<Lsf>();
  registry.add<FromLsf>();
  registry.add<Reflection>();
  registry.add<Residual>();
  registry.add<Resynthesise>();
  registry.add<Deemphasis>();
  registry.add<Join>();
  registry.add<Stack>();
  registry.add<Deltas>();
  registry.add<OneHot>();
  registry.add<PlaceInRecording>();
}

}  // namespace talkgraph
