#include "nodes/context/segment_online.h"

#include <algorithm>
#include <cmath>

#include "nodes/context/automaton.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

/// A segment that grows frame by frame.
class GrowingSegment {
 public:
  GrowingSegment(const Vlmm& vlmm, const FrameLabels& contexts, StateKind states, std::int64_t start)
      : vlmm_(vlmm), contexts_(contexts.labels), states_(states), segment_{"", start, 1} {
    segment_.label = states == StateKind::one ? one_state : label_of(start);
  }

  /// False if the frame after the last one does not belong to it.
  bool grow() {
    const auto frame = segment_.start + segment_.length;
    if (!goes_on(frame)) {
      ++phones_;
      const std::string label = label_of(frame);
      if (phone_count(label) != phones_) return false;
      segment_.label = label;
    }
    ++segment_.length;
    return true;
  }
  const Segment& segment() const { return segment_; }

 private:
  const std::string& context(std::int64_t frame) const { return contexts_[static_cast<std::size_t>(frame)]; }
  std::string label_of(std::int64_t frame) const {
    return state_label(vlmm_, states_ == StateKind::phones ? last_phone(context(frame)) : context(frame), phones_);
  }
  /// Whether a frame belongs to the run of the one before.
  bool goes_on(std::int64_t frame) const {
    if (states_ == StateKind::one) return true;
    const std::string phone = last_phone(context(frame));
    const bool runs = states_ == StateKind::phones || !vlmm_.repeating || is_end_pause(phone);
    return runs && last_phone(context(frame - 1)) == phone;
  }

  const Vlmm& vlmm_;
  const std::vector<std::string>& contexts_;
  StateKind states_;
  Segment segment_;
  std::int64_t phones_ = 1;
};

}  // namespace

ContextSegmentOnline::Out ContextSegmentOnline::operator()(const Vlmm& vlmm, const FrameLabels& contexts) const {
  const auto frames = static_cast<std::int64_t>(contexts.labels.size());
  const double period = 1000 / contexts.rate.value();
  const auto ahead = static_cast<std::int64_t>(std::floor(lookahead / period + 1e-9));
  Out out{{{}, frames, contexts.rate}, {}};
  std::int64_t sum = 0, most = 0;
  for (std::int64_t start = 0; start < frames;) {
    GrowingSegment growing(vlmm, contexts, states, start);
    std::int64_t heard = start;
    const std::int64_t last = std::min(start + ahead, frames - 1);
    while (heard < last) {
      ++heard;
      if (!growing.grow()) break;
    }
    const Segment& segment = growing.segment();
    for (std::int64_t t = start; t < start + segment.length; ++t) sum += heard - t;
    most = std::max(most, heard - start);
    start += segment.length;
    out.segments.segments.push_back(segment);
  }
  const double mean = frames > 0 ? static_cast<double>(sum) / static_cast<double>(frames) : 0;
  out.latency.values = {{"latency", period * mean}, {"latency_most", period * static_cast<double>(most)}};
  return out;
}

void describe(Description<ContextSegmentOnline>& d) {
  d.type("context.segment_online")
      .summary("cuts a stream of contexts into segments as it is heard")
      .source("this project's own; the thesis' Algorithm 4 begins at the end");
  d.input("vlmm", "the contexts").input("contexts", "context of each frame");
  d.output("segments", &ContextSegmentOnline::Out::segments, "they cover every frame");
  d.output("latency", &ContextSegmentOnline::Out::latency,
           "latency: how long frames wait for their segment to be cut, mean, ms; latency_most: the longest, ms");
  d.param("states", &ContextSegmentOnline::states).doc("what a state stands for; as in context.windows");
  d.param("lookahead", &ContextSegmentOnline::lookahead)
      .at_least(0)
      .unit("ms")
      .doc("a segment is cut when it reaches this far from its first frame");
}

}  // namespace talkgraph
