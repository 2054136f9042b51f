#include "nodes/context/segment.h"

#include "nodes/context/automaton.h"

namespace talkgraph {
SegmentTrack ContextSegment::operator()(const Vlmm& vlmm, const FrameLabels& contexts) const {
  const auto frames = static_cast<std::int64_t>(contexts.labels.size());
  if (states == StateKind::one && frames > 0) return {{{one_state, 0, frames}}, frames, contexts.rate};
  std::vector<std::string> symbols;
  for (const auto& context : contexts.labels) symbols.push_back(last_phone(context));
  const auto parts = units(symbols, states == StateKind::phones || !vlmm.repeating);

  std::vector<Segment> backwards;
  for (auto end = static_cast<std::int64_t>(parts.size()); end > 0;) {
    const Unit& last = parts[static_cast<std::size_t>(end - 1)];
    const std::string& context =
        states == StateKind::phones ? last.symbol : contexts.labels[static_cast<std::size_t>(last.start)];
    const std::string label = state_label(vlmm, context, end);
    end -= phone_count(label);
    const auto start = parts[static_cast<std::size_t>(end)].start;
    const auto length = last.start + last.length - start;
    if (merge && !backwards.empty() && backwards.back().label == label)
      backwards.back() = {label, start, length + backwards.back().length};
    else
      backwards.push_back({label, start, length});
  }
  return {{backwards.rbegin(), backwards.rend()}, frames, contexts.rate};
}

void describe(Description<ContextSegment>& d) {
  d.type("context.segment")
      .summary("cuts a stream of contexts into segments that do not overlap")
      .source("Thesis §5.2.1, Algorithm 4");
  d.input("vlmm", "the contexts")
      .input("contexts", "context of each frame")
      .output("segments", "they cover every frame");
  d.param("states", &ContextSegment::states).doc("what a state stands for; as in context.windows");
  d.param("merge", &ContextSegment::merge).doc("neighbours of one label become one segment");
}

}  // namespace talkgraph
