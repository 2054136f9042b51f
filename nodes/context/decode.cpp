#include "nodes/context/decode.h"

#include "nodes/context/automaton.h"

namespace talkgraph {

FrameLabels ContextDecode::operator()(const Vlmm& vlmm, const FrameLabels& labels) const {
  FrameLabels contexts;
  contexts.rate = labels.rate;
  AutomatonReader reader(vlmm);
  for (const auto& unit : units(vlmm, labels.labels))
    contexts.labels.insert(contexts.labels.end(), static_cast<std::size_t>(unit.length),
                           reader.read(unit.symbol).label);
  return contexts;
}

void describe(Description<ContextDecode>& d) {
  d.type("context.decode").summary("the context of each frame of a phone stream").source("Thesis §5.2.1, Figure 5.9");
  d.input("vlmm", "the contexts")
      .input("labels", "phones at the video rate")
      .output("contexts", "phones joined by -, oldest first: k-ae-t");
}

}  // namespace talkgraph
