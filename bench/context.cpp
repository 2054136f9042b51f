// What phonetic contexts cost: processor time of one core over 100,000 frames of phones.

#include <fmt/format.h>

#include "bench/rows.h"
#include "graph/random.h"
#include "nodes/context/decode.h"
#include "nodes/context/segment.h"
#include "nodes/context/train.h"

namespace talkgraph::bench {

constexpr std::uint64_t frames = 100'000, sentence = 75, phones = 40;

/// Sentences of phones that last `longest` frames at most, each followed by one of `followers` phones.
Collected<FrameLabels> sentences(std::uint64_t longest, std::uint64_t followers) {
  Random random(1);
  Collected<FrameLabels> all;
  for (std::uint64_t i = 0; i * sentence < frames; ++i) {
    FrameLabels labels;
    std::uint64_t phone = random.below(phones);
    while (labels.labels.size() < sentence) {
      labels.labels.insert(labels.labels.end(), 1 + random.below(longest), fmt::format("p{}", phone));
      phone = (7 * phone + random.below(followers)) % phones;
    }
    labels.labels.resize(sentence);
    all.add(fmt::format("{}", i), std::move(labels));
  }
  return all;
}

void compare() {
  const auto speech = sentences(6, 8), noise = sentences(1, phones);
  const ContextTrain train, runs{.repeating = false};
  const ContextTrain all{.order = 10, .keep = 0};
  const Vlmm model = train(speech);
  std::vector<Row> rows = {
      {"train on phones of 1 to 6 frames", own([&] { train(speech); })},
      {"train on their runs", own([&] { runs(speech); })},
      {"train on another phone each frame, drawn from all", own([&] { train(noise); })},
      {"train to order 10, all memories kept", own([&] { all(speech); })},
      {"decode and segment", own([&] {
         for (std::size_t i = 0; i < speech.size(); ++i) ContextSegment{}(model, ContextDecode{}(model, speech[i]));
       })},
  };
  measure(rows);
  fmt::print("Processor time for {} frames of {} phones, median of {} (least to most):\n\n", frames, phones, rounds);
  fmt::print("| contexts | seconds |\n|---|---|\n");
  for (const auto& row : rows)
    fmt::print("| {} | {:.3f} ({:.3f} to {:.3f}) |\n", row.name, row.median(), row.seen.front(), row.seen.back());
}

}  // namespace talkgraph::bench

int main() {
  try {
    talkgraph::bench::compare();
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_context: {}\n", e.what());
    return 1;
  }
}
