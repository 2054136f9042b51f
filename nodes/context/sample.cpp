#include "nodes/context/sample.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "nodes/context/automaton.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

class Sampler {
 public:
  explicit Sampler(const Vlmm& vlmm) : vlmm_(vlmm), frames_(vlmm.alphabet.size(), 1) {
    for (const auto& state : vlmm.states) weights_.push_back(state.probability);
    for (std::size_t s = 0; s < vlmm.alphabet.size(); ++s)
      if (is_end_pause(vlmm.alphabet[s]))
        for (auto& weights : weights_) weights[s] = 0;
    if (weights_.empty() || sum(weights_[0]) == 0)
      throw std::runtime_error("the contexts have no transition to begin with: all were pruned in training");
    if (!vlmm.repeating) find_lengths();
  }

  std::vector<std::string> draw(std::int64_t most, Random& random) const {
    std::vector<std::string> labels;
    std::size_t state = 0;
    for (std::int64_t i = 0; i < most; ++i) {
      if (sum(weights_[state]) == 0) state = 0;
      const std::size_t symbol = draw_symbol(weights_[state], random);
      labels.insert(labels.end(), frames_[symbol], vlmm_.alphabet[symbol]);
      state = state_after(vlmm_, state, static_cast<std::int64_t>(symbol));
      if (random.uniform() < vlmm_.states[state].end) break;
    }
    return labels;
  }

 private:
  static double sum(const std::vector<double>& weights) { return std::accumulate(weights.begin(), weights.end(), 0.0); }

  static std::size_t draw_symbol(const std::vector<double>& weights, Random& random) {
    double left = random.uniform() * sum(weights);
    std::size_t last = 0;  // of those that can be drawn: rounding may leave some rest behind it
    for (std::size_t s = 0; s < weights.size(); ++s) {
      if (weights[s] == 0) continue;
      last = s;
      if (left < weights[s]) break;
      left -= weights[s];
    }
    return last;
  }

  /// Mean frames of the runs of each symbol.
  void find_lengths() {
    std::vector<double> frames(frames_.size());
    for (const auto& [label, count] : vlmm_.occupancy)
      frames[static_cast<std::size_t>(index_of(vlmm_, label.substr(label.rfind('-') + 1)))] +=
          static_cast<double>(count);
    for (std::size_t s = 0; s < frames.size(); ++s) {
      const auto runs = static_cast<double>(vlmm_.windows.at(vlmm_.alphabet[s]));
      if (runs > 0) frames_[s] = static_cast<std::size_t>(std::max(1.0, std::round(frames[s] / runs)));
    }
  }

  const Vlmm& vlmm_;
  std::vector<std::vector<double>> weights_;
  std::vector<std::size_t> frames_;
};

}  // namespace

Stream<FrameLabels> ContextSample::operator()(const Vlmm& vlmm, Random& random) const {
  const Sampler sampler(vlmm);
  auto drawn = std::make_shared<std::vector<FrameLabels>>();
  for (std::int64_t i = 0; i < sequences; ++i) drawn->push_back({sampler.draw(most, random), rate});
  return Stream<FrameLabels>(
      [drawn, i = std::size_t{0}]() mutable -> std::optional<Item<FrameLabels>> {
        if (i == drawn->size()) return {};
        auto& labels = (*drawn)[i++];
        return Item<FrameLabels>{fmt::format("sample{:03}", i), std::move(labels)};
      },
      drawn->size());
}

void describe(Description<ContextSample>& d) {
  d.type("context.sample").summary("new phone streams drawn from contexts");
  d.input("vlmm", "the contexts").output("labels", "one symbol after the other, at the video rate");
  d.param("sequences", &ContextSample::sequences).at_least(1).doc("how many are drawn");
  d.param("most", &ContextSample::most).at_least(1).unit("symbols").doc("longest sequence: frames, or runs of frames");
  d.param("rate", &ContextSample::rate).positive().unit("frames/s").doc("of the frames");
}

}  // namespace talkgraph
