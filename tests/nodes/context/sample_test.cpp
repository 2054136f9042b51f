#include "nodes/context/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "graph/random.h"
#include "nodes/context/automaton.h"
#include "nodes/context/train.h"

namespace talkgraph {
namespace {

std::vector<Item<FrameLabels>> drawn(const ContextSample& node, const Vlmm& v, std::uint64_t seed = 1) {
  Random random(seed);
  auto stream = node(v, random);
  std::vector<Item<FrameLabels>> all;
  while (auto item = stream.next()) all.push_back(*item);
  return all;
}

FrameLabels stream(const std::string& letters) {
  FrameLabels f;
  for (const char c : letters) f.labels.emplace_back(1, c);
  return f;
}

Vlmm learnt(bool repeating = true) {
  const ContextTrain train{.order = 2, .prune = 0, .keep = 0.001, .repeating = repeating};
  return train({{"x", stream("aaabccabbbaacaabbacbbcabacccab")}, {"y", stream("ccabaaabbcacbaacbab")}});
}

TEST(ContextSample, DrawsTransitionsAsOftenAsTheyAreLikely) {
  const Vlmm v = learnt();
  std::map<std::string, double> counts, expected;
  double ends = 0, expected_ends = 0;
  for (const auto& item : drawn({4000, 500, Rational(50)}, v)) {
    EXPECT_EQ(item.value.rate, Rational(50));
    std::size_t state = 0;
    for (const auto& symbol : item.value.labels) {
      const auto s = static_cast<std::size_t>(index_of(v, symbol));
      const std::string memory = memory_label(v, v.states[state].memory);
      ASSERT_GE(v.states[state].next[s], 0) << memory << " " << symbol;
      ++counts[memory + " " + symbol];
      for (std::size_t i = 0; i < v.alphabet.size(); ++i)
        expected[memory + " " + v.alphabet[i]] += v.states[state].probability[i];
      state = state_after(v, state, static_cast<std::int64_t>(s));
      expected_ends += v.states[state].end;
    }
    ++ends;
  }
  EXPECT_NEAR(ends, expected_ends, 5 * std::sqrt(ends));
  EXPECT_GT(counts.size(), 12u);
  for (const auto& [transition, n] : expected)
    EXPECT_NEAR(counts[transition], n, 5 * std::sqrt(n) + 1e-9) << transition;
}

TEST(ContextSample, FollowsItsSeed) {
  const Vlmm v = learnt();
  const auto labels = [&](std::uint64_t seed) { return drawn({}, v, seed).at(1).value.labels; };
  EXPECT_EQ(labels(3), labels(3));
  EXPECT_NE(labels(3), labels(4));
  EXPECT_EQ(drawn({}, v).at(9).key, "sample010");
  // These bits are the same on every machine.
  std::string text;
  for (const auto& item : drawn({3, 30}, v))
    for (const auto& symbol : item.value.labels) text += symbol;
  EXPECT_EQ(text, "bbcacccaaabbbacabbaaababcaccabbabbbaaaacbaabbaccabaacababbcacbacbaabaaccacbbccaacbbaa");
}

// Runs of a last 2, 1, 2 and 3 frames, those of b 4.
TEST(ContextSample, GivesRunsTheirMeanLength) {
  const ContextTrain train{.order = 1, .prune = 0, .keep = 0.001, .repeating = false};
  const Vlmm v = train({{"x", stream("aabbbbabbbbaabbbbaaa")}});
  for (const auto& item : drawn({20, 5}, v)) {
    const auto runs = units(item.value.labels, true);
    EXPECT_LE(runs.size(), 5u);
    for (const auto& run : runs) EXPECT_EQ(run.length, run.symbol == "a" ? 2 : 4);
  }
}

TEST(ContextSample, DrawsNoPausesOfTheEnds) {
  const ContextTrain train{.order = 1, .prune = 0, .keep = 0};
  const Vlmm v = train({{"x", {{"lead_sil", "lead_sil", "a", "b", "trail_sil"}, Rational(25)}}});
  for (const auto& item : drawn({20, 40}, v)) {
    EXPECT_EQ(item.value.labels.back(), "b");
    for (const auto& symbol : item.value.labels) EXPECT_TRUE(symbol == "a" || symbol == "b") << symbol;
  }
}

// All that follows c is pruned, and no stream ends with it.
TEST(ContextSample, RestartsWhereNothingFollows) {
  const ContextTrain train{.order = 1, .prune = 0.1, .keep = 0};
  const Vlmm v = train({{"x", stream("caaacbbbcaaabbbbbaaa")}});
  std::size_t after = 0;
  for (const auto& item : drawn({20, 40}, v)) {
    const auto& labels = item.value.labels;
    for (std::size_t i = 0; i + 1 < labels.size(); ++i) after += labels[i] == "c";
  }
  EXPECT_GT(after, 0u);
}

TEST(ContextSample, RefusesAModelWithoutTransitions) {
  const ContextTrain train{.prune = 1};
  EXPECT_THROW(drawn({}, train({{"x", stream("ab")}})), std::runtime_error);
  EXPECT_THROW(drawn({}, train({{"x", {{"lead_sil"}, Rational(25)}}})), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
