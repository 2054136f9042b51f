#include "nodes/phones/register.h"

#include "nodes/phones/align.h"
#include "nodes/phones/label_frames.h"
#include "nodes/phones/mark_pauses.h"
#include "nodes/phones/masks.h"
#include "nodes/phones/recognise.h"
#include "nodes/phones/time_labels.h"
#include "nodes/phones/visemes.h"
#include "nodes/phones/vote_labels.h"

namespace talkgraph {

void register_phones(Registry& registry) {
  registry.add<Align>();
  registry.add<Recognise>();
  registry.add<LabelFrames>();
  registry.add<TimeLabels>();
  registry.add<MarkPauses>();
  registry.add<SpeechMask>();
  registry.add<WordMask>();
  registry.add<ToVisemes>();
  registry.add<VoteLabels>();
}

}  // namespace talkgraph
