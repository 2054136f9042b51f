#include "tests/nodes/context/written_out.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "graph/random.h"
#include "nodes/context/decode.h"
#include "nodes/context/perplexity.h"
#include "nodes/context/segment.h"
#include "nodes/context/train.h"

namespace talkgraph {
namespace {

using testing::WrittenOutContexts;
using Word = WrittenOutContexts::Word;

const Word kPhones = {"aa", "ae", "b", "d", "iy", "p", "s", "sil", "t"};  // some share a viseme

Word random_word(Random& random, std::uint64_t symbols, std::uint64_t length) {
  const double changes = random.uniform(0.2, 0.9);
  Word word;
  std::string at = kPhones[random.below(symbols)];
  for (std::uint64_t i = 0; i < length; ++i) {
    if (random.uniform() < changes) at = kPhones[random.below(symbols)];
    word.push_back(at);
  }
  return word;
}

Word without_repeats(Word word) {
  word.erase(std::unique(word.begin(), word.end()), word.end());
  return word;
}

FrameLabels frames(const Word& word) { return {word, Rational(25)}; }

struct Drawn {
  ContextTrain train;
  std::vector<Word> streams, held_out;

  explicit Drawn(std::uint64_t seed) {
    Random random(seed);
    const std::uint64_t symbols = 1 + random.below(kPhones.size() - 2);
    const double keeps[] = {0, 1e-4, 1e-3, 1e-2}, prunes[] = {0, 0, 0.005, 0.03};
    train.order = static_cast<int>(random.below(7));
    train.keep = keeps[random.below(4)];
    train.prune = prunes[random.below(4)];
    train.min_windows = static_cast<int>(1 + random.below(6));
    train.repeating = random.below(2) == 0;
    for (int i = 0; i < 3; ++i) streams.push_back(random_word(random, symbols, 10 + random.below(60)));
    // Two phones that were never trained on, one of them with a viseme that may have been.
    for (std::uint64_t n : {0, 1, 2, 7, 40}) held_out.push_back(random_word(random, symbols + 2, n));
    held_out.push_back(Word{"sil", "no phone", "p"});
  }
  WrittenOutContexts written_out() const {
    std::vector<Word> read;
    for (const auto& stream : streams) read.push_back(as_read(stream));
    return {read,
            {static_cast<std::size_t>(train.order), train.prune, train.keep, static_cast<double>(train.min_windows)}};
  }
  Word as_read(const Word& stream) const { return train.repeating ? stream : without_repeats(stream); }
  Vlmm vlmm() const {
    Collected<FrameLabels> labels;
    for (std::size_t i = 0; i < streams.size(); ++i) labels.add(std::to_string(i), frames(streams[i]));
    return train(labels);
  }
  std::string name() const {
    return fmt::format("order {}, prune {}, keep {}, min_windows {}, {}", train.order, train.prune, train.keep,
                       train.min_windows, train.repeating ? "frames" : "runs");
  }
};

Word memory_of(const Vlmm& v, std::size_t state) {
  Word word;
  for (const auto symbol : v.states[state].memory) word.push_back(v.alphabet[static_cast<std::size_t>(symbol)]);
  return word;
}

constexpr std::uint64_t kDraws = 150;

TEST(WrittenOut, ModelsAgree) {
  std::size_t longest = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Drawn drawn(seed);
    SCOPED_TRACE(drawn.name());
    const Vlmm v = drawn.vlmm();
    const auto expected = drawn.written_out();
    ASSERT_EQ(Word(expected.alphabet.begin(), expected.alphabet.end()), v.alphabet);
    std::set<Word> memories;
    for (std::size_t s = 0; s < v.states.size(); ++s) memories.insert(memory_of(v, s));
    ASSERT_EQ(memories, expected.memories);
    ASSERT_EQ(memories.size(), v.states.size());
    EXPECT_EQ(v.windows, expected.windows);
    for (std::size_t s = 0; s < v.states.size(); ++s) {
      const Word memory = memory_of(v, s);
      longest = std::max(longest, memory.size());
      const auto next = expected.next(memory);
      for (std::size_t i = 0; i < v.alphabet.size(); ++i) {
        const auto p = next.find(v.alphabet[i]);
        ASSERT_EQ(v.states[s].next[i] >= 0, p != next.end());
        if (p == next.end()) continue;
        EXPECT_NEAR(v.states[s].probability[i], p->second, 1e-12);
        Word longer = memory;
        longer.push_back(v.alphabet[i]);
        EXPECT_EQ(memory_of(v, static_cast<std::size_t>(v.states[s].next[i])), expected.longest_memory(longer));
      }
    }
  }
  EXPECT_EQ(longest, 6u);
}

TEST(WrittenOut, LabelsAgree) {
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Drawn drawn(seed);
    SCOPED_TRACE(drawn.name());
    const Vlmm v = drawn.vlmm();
    const auto expected = drawn.written_out();
    std::map<std::string, std::int64_t> occupancy;
    for (const auto* streams : {&drawn.streams, &drawn.held_out})
      for (const auto& stream : *streams) {
        const auto labels = expected.read(drawn.as_read(stream));
        Word of_frames;
        std::size_t read = 0;
        for (std::size_t t = 0; t < stream.size(); ++t) {
          if (t > 0 && (drawn.train.repeating || stream[t] != stream[t - 1])) ++read;
          of_frames.push_back(WrittenOutContexts::joined(labels.at(read).first));
          if (streams == &drawn.streams) ++occupancy[of_frames.back()];
        }
        EXPECT_EQ(ContextDecode{}(v, frames(stream)).labels, of_frames);
      }
    EXPECT_EQ(v.occupancy, occupancy);
  }
}

TEST(WrittenOut, SegmentsAgree) {
  std::size_t shortened = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Drawn drawn(seed);
    SCOPED_TRACE(drawn.name());
    const Vlmm v = drawn.vlmm();
    const auto expected = drawn.written_out();
    for (const auto& stream : drawn.held_out) {
      const auto contexts = ContextDecode{}(v, frames(stream));
      std::vector<std::pair<std::string, std::int64_t>> found, wanted;
      for (const auto& s : ContextSegment{}(v, contexts).segments) {
        found.emplace_back(s.label, s.start);
        shortened += s.label.size() < contexts.labels[static_cast<std::size_t>(s.start + s.length - 1)].size();
      }
      std::vector<std::int64_t> starts;
      for (std::size_t t = 0; t < stream.size(); ++t)
        if (t == 0 || drawn.train.repeating || stream[t] != stream[t - 1])
          starts.push_back(static_cast<std::int64_t>(t));
      for (const auto& [label, first] : expected.segments(drawn.as_read(stream)))
        wanted.emplace_back(label, starts[first]);
      EXPECT_EQ(found, wanted);
    }
  }
  EXPECT_GT(shortened, 100u);
}

TEST(WrittenOut, EntropiesAgree) {
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Drawn drawn(seed);
    SCOPED_TRACE(drawn.name());
    const auto expected = drawn.written_out();
    Collected<FrameLabels> labels;
    double bits = 0, best = 0, symbols = 0;
    for (const auto& stream : drawn.held_out) {
      labels.add(std::to_string(labels.size()), frames(stream));
      const Word read = drawn.as_read(stream);
      bits += expected.bits(read, {}, 1e-3);
      best += expected.best_path_bits(read, 1e-3);
      symbols += static_cast<double>(read.size());
    }
    const Table t = ContextPerplexity{.floor = 1e-3}(drawn.vlmm(), labels);
    EXPECT_NEAR(t.cells[0][1], bits / symbols, 1e-12);
    EXPECT_NEAR(t.cells[0][2], best / symbols, 1e-12);
    EXPECT_LE(t.cells[0][2], t.cells[0][1] + 1e-12);
  }
}

}  // namespace
}  // namespace talkgraph
