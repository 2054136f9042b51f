#include "nodes/context/segment.h"

#include <algorithm>

#include "nodes/context/automaton.h"

namespace talkgraph {
namespace {

std::string last_phone(const std::string& label) { return label.substr(label.rfind('-') + 1); }

std::vector<Segment> context_segments(const Vlmm& vlmm, const std::vector<std::string>& contexts) {
  std::vector<Segment> backwards;
  for (auto end = static_cast<std::int64_t>(contexts.size()); end > 0;) {
    auto phones = label_phones(trainable_suffix(vlmm, contexts[static_cast<std::size_t>(end - 1)]));
    const auto length = std::min<std::int64_t>(static_cast<std::int64_t>(phones.size()), end);
    // Clipped at the first frame, the label loses its oldest phones and may be thin again.
    auto label = join_phones(phones, phones.size() - static_cast<std::size_t>(length), phones.size());
    label = trainable_suffix(vlmm, label);
    const auto cut = static_cast<std::int64_t>(label_phones(label).size());
    backwards.push_back({label, end - cut, cut});
    end -= cut;
  }
  return {backwards.rbegin(), backwards.rend()};
}

std::vector<Segment> phone_segments(const std::vector<std::string>& contexts) {
  std::vector<Segment> segments;
  for (std::size_t t = 0; t < contexts.size(); ++t) {
    const auto phone = last_phone(contexts[t]);
    if (segments.empty() || segments.back().label != phone)
      segments.push_back({phone, static_cast<std::int64_t>(t), 0});
    ++segments.back().length;
  }
  return segments;
}

}  // namespace

SegmentTrack ContextSegment::operator()(const Vlmm& vlmm, const FrameLabels& contexts) const {
  SegmentTrack out;
  out.frames = static_cast<std::int64_t>(contexts.labels.size());
  out.rate = contexts.rate;
  out.segments =
      states == StateKind::contexts ? context_segments(vlmm, contexts.labels) : phone_segments(contexts.labels);
  return out;
}

void describe(Description<ContextSegment>& d) {
  d.type("context.segment")
      .summary("cuts a stream of contexts into segments that do not overlap")
      .source("Thesis §5.2.3, Algorithm 4");
  d.input("vlmm").input("contexts", "context of each frame").output("segments");
  d.param("states", &ContextSegment::states).doc("what a state stands for; as in context.windows");
}

}  // namespace talkgraph
