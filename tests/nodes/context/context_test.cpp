#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "graph/random.h"
#include "nodes/context/automaton.h"
#include "nodes/context/decode.h"
#include "nodes/context/inspect.h"
#include "nodes/context/perplexity.h"
#include "nodes/context/segment.h"
#include "nodes/context/train.h"
#include "nodes/context/windows.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

FrameLabels stream(const std::string& letters) {
  FrameLabels f;
  for (const char c : letters) f.labels.emplace_back(1, c);
  return f;
}

std::string random_stream(Random& random, int n, int symbols) {
  std::string s;
  char at = 'a';
  for (int i = 0; i < n; ++i) {
    if (random.uniform() < 0.4) at = static_cast<char>('a' + random.below(static_cast<std::uint64_t>(symbols)));
    s += at;
  }
  return s;
}

std::set<std::string> memories(const Vlmm& v) {
  std::set<std::string> all;
  for (const auto& s : v.states) {
    std::string w;
    for (const auto i : s.memory) w += v.alphabet[static_cast<std::size_t>(i)];
    all.insert(w);
  }
  return all;
}

// "abab...": after a always b, after b always a. The memories a and b predict
// far better than none; longer ones add nothing.
FrameLabels with_pauses(int lead, const std::string& letters, int trail) {
  FrameLabels f = stream(letters);
  f.labels.insert(f.labels.begin(), static_cast<std::size_t>(lead), "lead_sil");
  f.labels.insert(f.labels.end(), static_cast<std::size_t>(trail), "trail_sil");
  return f;
}

// Each pause at an end is one symbol, one window and one segment, and in no memory.
TEST(Contexts, PausesAtTheEndsHaveStatesOfTheirOwn) {
  const Collected<FrameLabels> labels = {{"x", with_pauses(3, "abababababababab", 4)},
                                         {"y", with_pauses(5, "babababababa", 2)}};
  const Vlmm v = ContextTrain{.order = 3, .prune = 0, .keep = 0.01, .min_windows = 1}(labels);
  EXPECT_EQ(memories(v), (std::set<std::string>{"", "a", "b"}));
  EXPECT_EQ(v.windows.at("lead_sil"), 2);
  EXPECT_EQ(v.occupancy.at("lead_sil"), 8);
  EXPECT_EQ(v.occupancy.at("trail_sil"), 6);

  const auto contexts = ContextDecode{}(v, with_pauses(2, "ab", 3));
  EXPECT_EQ(contexts.labels,
            (std::vector<std::string>{"lead_sil", "lead_sil", "a", "a-b", "trail_sil", "trail_sil", "trail_sil"}));
  const auto segments = ContextSegment{}(v, contexts).segments;
  ASSERT_EQ(segments.size(), 3u);
  EXPECT_EQ(segments[0].label + segments[1].label + segments[2].label, "lead_sila-btrail_sil");
  EXPECT_EQ(segments[2].start, 4);
  EXPECT_EQ(segments[2].length, 3);

  Collected<Track> tracks;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frames = static_cast<Eigen::Index>(labels[i].labels.size());
    tracks.add(labels.key(i), Track{Eigen::VectorXd::LinSpaced(frames, 0, static_cast<double>(frames - 1)), 25, 0, {}});
  }
  auto states = ContextWindows{}(v, labels, tracks, tracks);
  while (auto state = states.next()) {
    if (state->key != "trail_sil") continue;
    ASSERT_EQ(state->value.audio.size(), 2u);
    EXPECT_EQ(state->value.audio[0].rows(), 4);
    EXPECT_EQ(state->value.audio[1](0, 0), 17);
    return;
  }
  ADD_FAILURE() << "no state for trailing pauses";
}

TEST(ContextTrain, KeepsNoPauseOfTheEndsAsAMemory) {
  const ContextTrain all{.order = 1, .prune = 0, .keep = 0, .min_windows = 1};
  EXPECT_EQ(memories(all({{"x", with_pauses(3, "ab", 2)}})), (std::set<std::string>{"", "a", "b"}));
}

TEST(ContextWindows, LeaveOutLostFrames) {
  const Collected<FrameLabels> labels = {{"x", stream("abab")}};
  const Vlmm v = ContextTrain{.order = 1, .prune = 0, .keep = 0.01, .min_windows = 1}(labels);
  Track track{Eigen::Vector4d(0, 1, 2, 3), 25, 0, {}};
  track.lost = {1};
  const Collected<Track> tracks = {{"x", track}};
  auto states = ContextWindows{}(v, labels, tracks, tracks);
  std::map<std::string, std::size_t> windows;
  while (auto state = states.next()) windows[state->key] = state->value.visual.size();
  EXPECT_EQ(windows["a"], 2u);
  EXPECT_EQ(windows["b"], 1u);
  EXPECT_EQ(windows["b-a"], 0u);
  EXPECT_EQ(windows["a-b"], 1u);

  ContextWindows with_gaps;
  with_gaps.gaps = true;
  states = with_gaps(v, labels, tracks, tracks);
  while (auto state = states.next()) {
    windows[state->key] = state->value.visual.size();
    if (state->key != "b-a") continue;
    EXPECT_TRUE(state->value.visual[0].row(0).array().isNaN().all());
    EXPECT_TRUE(state->value.visual[0].row(1).allFinite() && state->value.audio[0].allFinite());
  }
  EXPECT_EQ(windows["b"], 2u);
  EXPECT_EQ(windows["b-a"], 1u);
}

TEST(ContextTrain, FindsTheSmallAutomatonOfAnAlternation) {
  const Vlmm v = ContextTrain{.order = 3, .prune = 0, .keep = 0.01}({{"x", stream("abababababababababab")}});
  EXPECT_EQ(memories(v), (std::set<std::string>{"", "a", "b"}));
  const auto& a = v.states[1];
  ASSERT_EQ(a.memory, std::vector<std::int64_t>{0});
  EXPECT_EQ(a.probability, (std::vector<double>{0, 1}));
  EXPECT_EQ(a.next, (std::vector<std::int64_t>{-1, 2}));
  EXPECT_EQ(ContextDecode{}(v, stream("aba")).labels, (std::vector<std::string>{"a", "a-b", "b-a"}));
}

// "aabaab..." by hand, of twelve symbols. p(a) = 2/3; p(a|a) = 1/2; p(a|b) = 1; after aa comes b, after ba comes a.
// Gains: b 1/3 ln 3/2, a 2/3 (ln 3/2 - ln 4/3)/2, aa 1/3 ln 2, ba 1/4 ln 2, ab nothing.
TEST(ContextTrain, FindsTheAutomatonOfAPeriodOfThree) {
  const Collected<FrameLabels> labels = {{"x", stream("aabaabaabaab")}};
  const ContextTrain train{.order = 2, .prune = 0, .keep = 0.01, .min_windows = 4};
  const Vlmm v = train(labels);
  ASSERT_EQ(memories(v), (std::set<std::string>{"", "a", "aa", "b", "ba"}));
  const std::vector<std::vector<std::int64_t>> next = {{1, 3}, {2, 3}, {-1, 3}, {4, -1}, {2, -1}};
  const std::vector<std::vector<double>> probability = {{2. / 3, 1. / 3}, {0.5, 0.5}, {0, 1}, {1, 0}, {1, 0}};
  for (std::size_t s = 0; s < 5; ++s) {
    EXPECT_EQ(v.states[s].next, next[s]) << s;
    for (std::size_t i = 0; i < 2; ++i) EXPECT_DOUBLE_EQ(v.states[s].probability[i], probability[s][i]);
  }
  EXPECT_EQ(v.states[0].end, 0);
  EXPECT_EQ(v.states[3].end, 0.25);
  EXPECT_EQ(ContextDecode{}(v, stream("aabaab")).labels,
            (std::vector<std::string>{"a", "a-a", "a-a-b", "b-a", "b-a-a", "a-a-b"}));
  EXPECT_EQ(v.windows, (std::map<std::string, std::int64_t>{{"a", 8}, {"a-a", 4}, {"a-a-b", 4}, {"b", 4}}));

  const auto kept = [&](double keep, double prune) {
    ContextTrain other = train;
    other.keep = keep, other.prune = prune;
    return memories(other(labels));
  };
  EXPECT_EQ(kept(0.174, 0), (std::set<std::string>{"", "a", "aa"}));  // a for the sake of aa
  EXPECT_EQ(kept(0.232, 0), (std::set<std::string>{""}));
  EXPECT_EQ(kept(0.01, 0.25), (std::set<std::string>{"", "a", "aa"}));  // ba, a quarter, is pruned: b predicts nothing
}

// Straight from the definitions: substrings counted by search, the criterion
// applied to every string of the right length.
TEST(ContextTrain, AgreesWithADirectSearch) {
  Random random(3);
  const std::vector<std::string> texts = {random_stream(random, 200, 3), random_stream(random, 150, 3)};
  const ContextTrain node{.order = 3, .prune = 0.01, .keep = 0.002};
  const Vlmm v = node({{"x", stream(texts[0])}, {"y", stream(texts[1])}});

  const auto count = [&](const std::string& w) {
    double n = 0;
    for (const auto& t : texts)
      for (std::size_t i = 0; i + w.size() <= t.size(); ++i) n += t.compare(i, w.size(), w) == 0;
    return n;
  };
  const auto unpruned = [&](const std::string& w) { return count(w) / 350 > node.prune ? count(w) : 0; };
  const auto next = [&](const std::string& w, char c) {
    const double sum = unpruned(w + "a") + unpruned(w + "b") + unpruned(w + "c");
    return sum > 0 ? unpruned(w + c) / sum : 0;
  };
  std::set<std::string> expected = {""};
  const std::function<void(const std::string&)> visit = [&](const std::string& w) {
    if (count(w) / 350 <= node.prune) return;
    double gain = 0;
    for (const char c : {'a', 'b', 'c'})
      if (next(w, c) > 0) gain += next(w, c) * std::log(next(w, c) / next(w.substr(1), c));
    if (count(w) / 350 * gain >= node.keep)
      for (std::size_t i = 0; i < w.size(); ++i) expected.insert(w.substr(i));
    if (static_cast<int>(w.size()) < node.order)
      for (const char c : {'a', 'b', 'c'}) visit(c + w);
  };
  for (const char c : {'a', 'b', 'c'}) visit(std::string(1, c));
  EXPECT_GT(expected.size(), 4u);
  EXPECT_EQ(memories(v), expected);
  for (const auto& state : v.states) {
    std::string w;
    for (const auto i : state.memory) w += v.alphabet[static_cast<std::size_t>(i)];
    for (std::size_t s = 0; s < 3; ++s) {
      const char c = v.alphabet[s][0];
      EXPECT_NEAR(state.probability[s], next(w, c), 1e-12) << w << " then " << c;
      std::string longest = w + c;
      while (!expected.contains(longest)) longest.erase(0, 1);
      const std::string reached = state.next[s] < 0 ? "none" : [&] {
        std::string m;
        for (const auto i : v.states[static_cast<std::size_t>(state.next[s])].memory)
          m += v.alphabet[static_cast<std::size_t>(i)];
        return m;
      }();
      EXPECT_EQ(reached, next(w, c) > 0 ? longest : "none") << w << " then " << c;
    }
  }
}

TEST(ContextTrain, CountsOccupancyAndWindows) {
  const Vlmm v = ContextTrain{.order = 1, .prune = 0, .keep = 0}({{"x", stream("aabaab")}});
  EXPECT_EQ(v.occupancy.at("a-a"), 2);
  EXPECT_EQ(v.occupancy.at("a-b"), 2);
  EXPECT_EQ(v.windows.at("a"), 4);
  EXPECT_EQ(state_label(v, "b"), "b");  // two windows, five are wanted, but no other phone of its viseme was met
  EXPECT_FALSE(v.trainable("a-a"));
  EXPECT_EQ(state_label(v, "b-a"), "a");
}

TEST(ContextTrain, RefusesNoFrames) {
  EXPECT_THROW(ContextTrain{}({}), std::runtime_error);
  EXPECT_THROW(ContextTrain{}({{"x", FrameLabels{}}}), std::runtime_error);
}

TEST(ContextTrain, TakesOneFrame) {
  const Vlmm v = ContextTrain{}({{"x", stream("a")}});
  EXPECT_EQ(ContextDecode{}(v, stream("aa")).labels, (std::vector<std::string>{"a", "a"}));
}

TEST(ContextDecode, AnswersUnseenPhonesAndTransitionsWithThePhoneAlone) {
  const Vlmm v = ContextTrain{.order = 2, .prune = 0, .keep = 0}({{"x", stream("aabbaabb")}});
  const auto labels = ContextDecode{}(v, stream("aaaqbb")).labels;
  EXPECT_EQ(labels[2], "a");  // aaa was never seen
  EXPECT_EQ(labels[3], "q");
  EXPECT_EQ(labels[4], "b");
  EXPECT_EQ(labels[5], "b-b");
  EXPECT_TRUE(ContextDecode{}(v, FrameLabels{}).labels.empty());
}

TEST(ContextSegment, CoversEveryFrameOnce) {
  Random random(5);
  Collected<FrameLabels> train;
  for (int i = 0; i < 6; ++i) train.add(std::to_string(i), stream(random_stream(random, 80, 5)));
  const Vlmm v = ContextTrain{.order = 4, .prune = 0, .keep = 1e-4, .min_windows = 3}(train);
  for (const auto states : {StateKind::contexts, StateKind::phones})
    for (int i = 0; i < 20; ++i) {
      const auto test = stream(random_stream(random, 1 + i * 3, 6));
      const auto contexts = ContextDecode{}(v, test);
      const auto track = ContextSegment{states}(v, contexts);
      std::int64_t at = 0;
      for (const auto& s : track.segments) {
        EXPECT_EQ(s.start, at);
        EXPECT_GT(s.length, 0);
        at += s.length;
        const auto phones = label_phones(s.label);
        if (states == StateKind::contexts) {
          ASSERT_EQ(static_cast<std::int64_t>(phones.size()), s.length);
          for (std::int64_t j = 0; j < s.length; ++j)
            EXPECT_EQ(phones[static_cast<std::size_t>(j)], test.labels[static_cast<std::size_t>(s.start + j)]);
        }
      }
      EXPECT_EQ(at, static_cast<std::int64_t>(test.labels.size()));
    }
  EXPECT_TRUE(ContextSegment{}(v, FrameLabels{}).segments.empty());
}

// Walking back from the end by hand: c takes a-b-c, then the frame before takes its own.
TEST(ContextSegment, WalksBackFromTheLastFrame) {
  Vlmm v;
  for (const char* label : {"a", "b", "c", "a-b", "a-b-c"}) v.windows[label] = 10;
  const FrameLabels contexts{{"a", "a-b", "a", "a-b", "a-b-c"}, Rational(25)};
  const auto track = ContextSegment{}(v, contexts);
  ASSERT_EQ(track.segments.size(), 2u);
  EXPECT_EQ(track.segments[0].label, "a-b");
  EXPECT_EQ(track.segments[1].label, "a-b-c");
  EXPECT_EQ(track.segments[1].start, 2);
}

TEST(ContextSegment, MergesNeighboursOfOneLabelIfAsked) {
  Vlmm v;
  for (const char* label : {"a", "b", "a-b"}) v.windows[label] = 10;
  const FrameLabels contexts{{"a", "a-b", "a", "a-b", "b", "b"}, Rational(25)};
  EXPECT_EQ(ContextSegment{}(v, contexts).segments.size(), 4u);
  const auto merged = ContextSegment{.merge = true}(v, contexts).segments;
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].label, "a-b");
  EXPECT_EQ(merged[0].start, 0);
  EXPECT_EQ(merged[0].length, 4);
  EXPECT_EQ(merged[1].label, "b");
  EXPECT_EQ(merged[1].start, 4);
  EXPECT_EQ(merged[1].length, 2);
}

Track ramp(int n, double offset) {
  Track t;
  t.values.resize(n, 1);
  for (int i = 0; i < n; ++i) t.values(i, 0) = offset + i;
  return t;
}

TEST(ContextWindows, FindsEveryWindowOfALabel) {
  const Collected<FrameLabels> labels{{"x", stream("aabaab")}, {"lost", stream("bbb")}};
  const Collected<Track> audio{{"x", ramp(6, 0)}}, visual{{"x", ramp(5, 100)}};
  Vlmm v = ContextTrain{.order = 1, .prune = 0, .keep = 0, .min_windows = 1}(labels);
  auto states = ContextWindows{}(v, labels, audio, visual);
  std::map<std::string, StateData> by_label;
  while (auto item = states.next()) by_label[item->key] = item->value;
  ASSERT_TRUE(by_label.contains("a-b"));
  // Five frames have all three: a a b a a.
  ASSERT_EQ(by_label.at("a-b").audio.size(), 1u);
  EXPECT_EQ(by_label.at("a-b").audio[0], Eigen::Vector2d(1, 2));
  EXPECT_EQ(by_label.at("a-b").visual[0], Eigen::Vector2d(101, 102));
  EXPECT_EQ(by_label.at("a-a").audio.size(), 2u);
  EXPECT_EQ(by_label.at("a").audio.size(), 4u);
}

TEST(ContextWindows, ThinsOutToTheMostFrames) {
  const Collected<FrameLabels> labels{{"x", stream(std::string(500, 'a'))}};
  const Collected<Track> audio{{"x", ramp(500, 0)}};
  const Vlmm v = ContextTrain{.order = 2, .prune = 0, .keep = 0, .min_windows = 1}(labels);
  auto states = ContextWindows{.max_frames = 100}(v, labels, audio, audio);
  while (auto item = states.next()) {
    std::size_t frames = 0;
    for (const auto& w : item->value.audio) frames += static_cast<std::size_t>(w.rows());
    EXPECT_LE(frames, 100u) << item->key;
    EXPECT_GE(frames, 90u) << item->key;
    EXPECT_GT(item->value.audio.back()(0, 0), 480) << "windows come from the whole stream";
  }
}

TEST(ContextWindows, TakesRunsWithPhonesAsStates) {
  const Collected<FrameLabels> labels{{"x", stream("aabbbac")}};
  const Collected<Track> audio{{"x", ramp(7, 0)}};
  const Vlmm v = ContextTrain{}(labels);
  auto states = ContextWindows{.states = StateKind::phones}(v, labels, audio, audio);
  const auto first = states.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->key, "a");
  EXPECT_EQ(first->value.audio.size(), 2u);
  EXPECT_EQ(first->value.audio[0].rows(), 2);
}

TEST(ContextWindows, OneStateHoldsUtterancesCutAtLostFrames) {
  const Collected<FrameLabels> labels{{"x", stream("aabbbac")}, {"y", stream("ab")}, {"z", stream("")}};
  Track cut = ramp(7, 100);
  cut.lost = {0, 3, 6};
  const Collected<Track> audio{{"x", ramp(7, 0)}, {"y", ramp(2, 50)}, {"z", ramp(0, 0)}},
      visual{{"x", cut}, {"y", ramp(2, 150)}, {"z", ramp(0, 0)}};
  auto states = ContextWindows{.states = StateKind::one}(Vlmm{}, labels, audio, visual);
  const auto state = states.next();
  ASSERT_TRUE(state);
  EXPECT_EQ(state->key, "utterance");
  ASSERT_EQ(state->value.audio.size(), 3u);
  EXPECT_EQ(state->value.audio[0], Eigen::Vector2d(1, 2));
  EXPECT_EQ(state->value.visual[1], Eigen::Vector2d(104, 105));
  EXPECT_EQ(state->value.audio[2], Eigen::Vector2d(50, 51));
  EXPECT_FALSE(states.next());
}

TEST(ContextSegment, OneStateMakesOneSegment) {
  const ContextSegment segment{StateKind::one};
  const auto track = segment(Vlmm{}, stream("aab"));
  ASSERT_EQ(track.segments.size(), 1u);
  EXPECT_EQ(track.segments[0].label, "utterance");
  EXPECT_EQ(track.segments[0].length, 3);
  EXPECT_EQ(track.frames, 3);
  EXPECT_TRUE(segment(Vlmm{}, FrameLabels{}).segments.empty());
}

TEST(ContextWindows, RefusesTracksOfOtherLengths) {
  const Collected<FrameLabels> labels{{"x", stream("aaaaaaaa")}};
  const Collected<Track> audio{{"x", ramp(8, 0)}}, visual{{"x", ramp(4, 0)}};
  const Vlmm v = ContextTrain{}(labels);
  EXPECT_THROW(ContextWindows{}(v, labels, audio, visual), std::runtime_error);
  EXPECT_THROW(ContextWindows{}(v, labels, audio, {}), std::runtime_error);
}

// A phone that was never heard is spoken for by the commonest of its viseme.
TEST(ContextSegment, AnswersAnUnknownPhoneByItsViseme) {
  const Vlmm v = ContextTrain{}({{"x", {{"sil", "p", "b", "b", "ae"}, Rational(25)}}});
  const auto label = [&](const std::string& phone) {
    return ContextSegment{}(v, {{phone}, Rational(25)}).segments.at(0).label;
  };
  EXPECT_EQ(label("m"), "b");
  EXPECT_EQ(label("breath"), "sil");
  EXPECT_EQ(label("s"), "s");  // no phone of its viseme is known
  EXPECT_EQ(label("7"), "7");
}

// b has four windows, five are wanted: p, the commonest of its viseme, speaks for it and learns alone.
TEST(ContextSegment, AnswersAThinPhoneByItsViseme) {
  const auto thin = [](std::vector<std::string> phones) {
    const Collected<FrameLabels> labels{{"x", {std::move(phones), Rational(25)}}};
    const auto frames = static_cast<Eigen::Index>(labels[0].labels.size());
    const Collected<Track> tracks{{"x", ramp(frames, 0)}};
    const Vlmm v = ContextTrain{.order = 0}(labels);
    std::vector<std::string> answers, learnt;
    for (const auto* phone : {"b", "m", "p"})
      answers.push_back(ContextSegment{}(v, {{phone}, Rational(25)}).segments.at(0).label);
    for (const auto kind : {StateKind::contexts, StateKind::phones}) {
      auto states = ContextWindows{.states = kind}(v, labels, tracks, tracks);
      while (const auto state = states.next()) learnt.push_back(state->key);
    }
    EXPECT_EQ(2 * state_labels(v).size(), learnt.size());
    return std::pair(answers, learnt);
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(thin({"b", "p", "b", "p", "b", "p", "p", "p", "b"}), std::pair(Words{"p", "p", "p"}, Words{"p", "p"}));
  // All are thin: each that was met has a state nevertheless.
  EXPECT_EQ(thin({"p", "b", "p"}), std::pair(Words{"b", "p", "p"}, Words{"p", "b", "p", "b"}));
}

// Whatever is said, every frame gets a label, and every segment a state that was trained, or else the phone that only
// the sound can tell about (state_for of nodes/mapping).
TEST(Contexts, AnswerWhatWasNeverTrainedOn) {
  for (const bool repeating : {true, false}) {
    const ContextTrain train{.prune = 0.02, .repeating = repeating};
    const Vlmm v = train({{"x", {{"sil", "p", "aa", "aa", "t", "aa", "p", "p", "s", "sil"}, Rational(25)}}});
    const auto labels = [&](const std::vector<std::string>& phones) {
      std::vector<std::string> all;
      for (const auto& s : ContextSegment{}(v, ContextDecode{}(v, {phones, Rational(25)})).segments)
        all.push_back(s.label);
      return all;
    };
    EXPECT_TRUE(labels({}).empty());
    EXPECT_EQ(labels({"aa"}), std::vector<std::string>{"aa"});
    EXPECT_EQ(labels({"m"}), std::vector<std::string>{"p"});
    EXPECT_EQ(labels({"d"}), std::vector<std::string>{"t"});
    EXPECT_EQ(labels({"breath"}), std::vector<std::string>{"sil"});
    EXPECT_EQ(labels({"lead_sil", "z", "trail_sil"}), (std::vector<std::string>{"sil", "s", "sil"}));
    EXPECT_EQ(labels({"w"}), std::vector<std::string>{"w"});
    EXPECT_EQ(labels({"s", "aa", "sil"}), (std::vector<std::string>{"s", "aa", "sil"}));
  }
}

// b, p and m are viseme 1, ae and aa 10: five of the six frames before the pause are one of two symbols.
TEST(Contexts, AreOfVisemesIfAsked) {
  const Collected<FrameLabels> labels = {
      {"x", {{"lead_sil", "b", "ae", "p", "aa", "m", "ae", "breath", "trail_sil"}, Rational(25)}}};
  const Vlmm v = ContextTrain{.order = 1, .keep = 0.01, .min_windows = 1, .symbols = SymbolKind::visemes}(labels);
  EXPECT_EQ(v.alphabet, (std::vector<std::string>{"1", "10", "lead_sil", "sil", "trail_sil"}));
  EXPECT_EQ(v.windows.at("1-10"), 3);
  // Phones that were not trained on, but whose visemes were.
  const auto contexts = ContextDecode{}(v, {{"m", "ah", "b", "s"}, Rational(25)});
  EXPECT_EQ(contexts.labels, (std::vector<std::string>{"1", "1-10", "10-1", "7"}));
  EXPECT_EQ(ContextSegment{}(v, contexts).segments.at(0).label, "1");

  const Collected<Track> tracks{{"x", ramp(9, 0)}};
  auto states = ContextWindows{}(v, labels, tracks, tracks);
  while (auto state = states.next())
    if (state->key == "1-10") {
      EXPECT_EQ(state->value.audio.size(), 3u);
      EXPECT_EQ(state->value.audio[1], Eigen::Vector2d(3, 4));
    }
  const Table t = ContextPerplexity{}(v, {{"y", {{"m", "ah", "m", "ah"}, Rational(25)}}});
  EXPECT_EQ(t.cells[0][3], 0) << "each transition is known";
  const ContextTrain train{.symbols = SymbolKind::visemes};
  EXPECT_THROW(train({{"x", {{"7"}, Rational(25)}}}), std::runtime_error);
}

TEST(ContextTrain, RefusesLabelsThatCannotBeJoined) {
  EXPECT_THROW(ContextTrain{}({{"x", {{"a-b"}, Rational(25)}}}), std::runtime_error);
  EXPECT_THROW(ContextTrain{}({{"x", {{""}, Rational(25)}}}), std::runtime_error);
}

TEST(ContextDecode, RefusesLabelsThatCannotBeJoined) {
  const Vlmm v = ContextTrain{}({{"x", stream("abab")}});
  for (const char* label : {"", "a-b"})
    EXPECT_THROW(ContextDecode{}(v, {{"a", label, "b"}, Rational(25)}), std::runtime_error) << label;
}

// "aabbb" is "ab" to a model of runs: contexts and windows hold whole runs.
TEST(ContextRuns, StandForTheirFrames) {
  const Collected<FrameLabels> labels{{"x", stream("aabbbaab")}};
  const Vlmm v = ContextTrain{.order = 1, .prune = 0, .keep = 0.01, .min_windows = 2, .repeating = false}(labels);
  const auto contexts = ContextDecode{}(v, stream("aabbba"));
  EXPECT_EQ(contexts.labels, (std::vector<std::string>{"a", "a", "a-b", "a-b", "a-b", "b-a"}));
  EXPECT_EQ(v.occupancy.at("a-b"), 4);
  EXPECT_EQ(v.windows, (std::map<std::string, std::int64_t>{{"a", 2}, {"a-b", 2}, {"b", 2}}));

  const auto track = ContextSegment{}(v, contexts);
  ASSERT_EQ(track.segments.size(), 2u);
  EXPECT_EQ(track.segments[0].label, "a-b");
  EXPECT_EQ(track.segments[0].length, 5);
  EXPECT_EQ(track.segments[1].label, "a");
  EXPECT_EQ(track.segments[1].start, 5);

  const Collected<Track> tracks{{"x", ramp(8, 0)}};
  auto states = ContextWindows{}(v, labels, tracks, tracks);
  const auto first = states.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->key, "a-b");
  ASSERT_EQ(first->value.audio.size(), 2u);
  EXPECT_EQ(first->value.audio[0].rows(), 5);
  EXPECT_EQ(first->value.audio[1], Eigen::Vector3d(5, 6, 7));
}

// Of a, b with p(b|a) = 1, p(a|b) = 1/2, p(b|b) = 1/2: one and a half bits by hand.
TEST(ContextPerplexity, IsThatOfTheTransitions) {
  Vlmm v;
  v.alphabet = {"a", "b"};
  v.states = {{{}, {0.5, 0.5}, {1, 2}}, {{0}, {0, 1}, {-1, 2}}, {{1}, {0.5, 0.5}, {1, 2}}};
  const auto score = [&](const std::string& letters, const std::string& column) {
    const Table t = ContextPerplexity{.floor = 0.25}(v, {{"x", stream(letters)}});
    return t
        .cells[0][static_cast<std::size_t>(std::find(t.columns.begin(), t.columns.end(), column) - t.columns.begin())];
  };
  EXPECT_DOUBLE_EQ(score("abab", "entropy"), 0.5);  // 1 + 0 + 1 + 0 bits of four
  EXPECT_DOUBLE_EQ(score("abab", "perplexity"), std::sqrt(2));
  EXPECT_DOUBLE_EQ(score("aa", "entropy"), 1.5);  // the floor for a after a
  EXPECT_DOUBLE_EQ(score("aa", "missed"), 0.5);
  EXPECT_DOUBLE_EQ(score("q", "entropy"), 2);
  EXPECT_DOUBLE_EQ(score("baba", "entropy"), 0.75);   // 1 + 1 + 0 + 1
  EXPECT_DOUBLE_EQ(score("baba", "best_path"), 0.5);  // begun in a: 0 + 1 + 0 + 1
  EXPECT_THROW(ContextPerplexity{}(v, {}), std::runtime_error);
}

TEST(ContextPerplexity, CountsTheLabelsThatTheSummaryCallsTrainable) {
  const Collected<FrameLabels> labels{{"x", stream("abcabcabcabcabcaab")}};
  const Vlmm v = ContextTrain{.keep = 1e-9, .min_windows = 100}(labels);
  const auto column = [](const Table& t, const std::string& name) {
    return t.cells[0].at(
        static_cast<std::size_t>(std::find(t.columns.begin(), t.columns.end(), name) - t.columns.begin()));
  };
  const Table held_out = ContextPerplexity{}(v, labels), summary = InspectContexts{}(v).summary;
  EXPECT_EQ(column(held_out, "trainable"), column(summary, "trainable"));
  EXPECT_LT(column(summary, "trainable"), column(summary, "labels"));
}

}  // namespace
}  // namespace talkgraph
