#include "nodes/context/decode.h"

#include "nodes/context/automaton.h"

namespace talkgraph {

FrameLabels ContextDecode::operator()(const Vlmm& vlmm, const FrameLabels& labels) const {
  return {context_labels(vlmm, labels.labels), labels.rate};
}

void describe(Description<ContextDecode>& d) {
  d.type("context.decode").summary("the context of each frame of a phone stream").source("Thesis §5.2.1, Figure 5.9");
  d.input("vlmm").input("labels", "phones at the video rate").output("contexts");
}

}  // namespace talkgraph
