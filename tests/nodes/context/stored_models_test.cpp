#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph/random.h"
#include "nodes/context/decode.h"
#include "nodes/context/inspect.h"
#include "nodes/context/perplexity.h"
#include "nodes/context/sample.h"
#include "nodes/context/segment.h"
#include "nodes/context/train.h"
#include "tests/nodes/types/changed_members.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using ::testing::HasSubstr;

Vlmm learnt() {
  const ContextTrain train{.order = 3, .prune = 0, .keep = 0, .min_windows = 2, .repeating = false};
  const std::vector<std::string> phones = {"aa", "aa", "b", "p", "aa", "b", "aa", "s", "aa", "b", "b", "p", "aa"};
  return train({{"x", {phones, Rational(25)}}});
}

Eigen::MatrixXd use(const Vlmm& v) {
  const FrameLabels spoken{{"b", "aa", "m", "s", "zh", "aa", "aa", "b", "p"}, Rational(25)};
  const auto segments = ContextSegment{}(v, ContextDecode{}(v, spoken)).segments;
  if (segments.empty()) throw std::runtime_error("nothing was said");
  Random random(1);
  auto samples = ContextSample{.sequences = 2, .most = 20}(v, random);
  while (samples.next()) {
  }
  InspectContexts{}(v);
  const Table t = ContextPerplexity{}(v, {{"x", spoken}});
  return Eigen::Map<const Eigen::RowVectorXd>(t.cells[0].data(), std::ssize(t.cells[0]));
}

TEST(StoredContexts, FitTogetherOrAreRefused) { EXPECT_GT(testing::refuses_or_answers<Vlmm>(learnt(), use), 30); }

TEST(StoredContexts, AreSavedWhole) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("vlmm.h5");
  Vlmm v = learnt(), back;
  v.visemes = true;
  write_hdf5(path, [&](Archive& ar) { ar("v", v); });
  (*hdf5_reader(path))("v", back);
  const auto hash = [](Vlmm& x) { return content_key([&](Archive& ar) { fields(ar, x); }); };
  EXPECT_EQ(hash(back), hash(v));
  EXPECT_EQ(back.states.size(), v.states.size());
  EXPECT_FALSE(back.repeating);
  EXPECT_EQ(back.states.back().memory, v.states.back().memory);
}

TEST(StoredContexts, SayWhatDoesNotFit) {
  const auto complaint = [](const std::function<void(Vlmm&)>& damage) -> std::string {
    testing::MemoryArchive archive;
    Vlmm v = learnt(), loaded;
    damage(v);
    fields(archive, v);
    archive.loads = true;
    try {
      fields(archive, loaded);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(complaint([](Vlmm&) {}), "");
  EXPECT_THAT(complaint([](Vlmm& v) { v = {}; }),
              HasSubstr("the stored model of contexts is damaged: its \"memories\""));
  EXPECT_THAT(complaint([](Vlmm& v) { v.order = 1; }), HasSubstr("\"order\" is shorter than a memory"));
  EXPECT_THAT(complaint([](Vlmm& v) { std::swap(v.alphabet[0], v.alphabet[1]); }), HasSubstr("not sorted"));
  EXPECT_THAT(complaint([](Vlmm& v) { v.alphabet.push_back("zh"); }), HasSubstr("\"next\" is not one a state"));
  EXPECT_THAT(complaint([](Vlmm& v) { v.states[0].probability[0] /= 2; }), HasSubstr("\"probabilities\""));
  EXPECT_THAT(complaint([](Vlmm& v) { v.states[0].next[0] = 0x7fffffff; }), HasSubstr("\"next\" leads to no state"));
  EXPECT_THAT(complaint([](Vlmm& v) { std::swap(v.states[0].next[0], v.states[0].next[1]); }),
              HasSubstr("another context"));
  EXPECT_THAT(complaint([](Vlmm& v) { v.states.back().memory.back() = 17; }), HasSubstr("\"memories\""));
  EXPECT_THAT(complaint([](Vlmm& v) { v.states[0].end = 2; }), HasSubstr("\"ends\" are no shares"));
  EXPECT_THAT(complaint([](Vlmm& v) { v.windows.erase("p"); }), HasSubstr("\"windows\" lack a symbol"));
  EXPECT_THAT(complaint([](Vlmm& v) { v.occupancy["q"] = 1; }), HasSubstr("\"occupancy\" names no symbol"));
  EXPECT_THAT(complaint([](Vlmm& v) { v.occupancy["p"] = -1; }), HasSubstr("below 0"));
}

}  // namespace
}  // namespace talkgraph
