#include "runtime/executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>

#include "runtime/books.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using In = GraphBuilder::In;
using testing::ElementsAre;
using testing::HasSubstr;

class ExecutorTest : public testing::TestWithParam<Executor> {
 protected:
  RunResult go() { return run(b_.graph, options_); }
  RunError error() {
    try {
      go();
    } catch (const RunError& e) {
      return e;
    }
    ADD_FAILURE() << "the run did not fail";
    return RunError({});
  }
  void SetUp() override { options_.executor = GetParam(); }
  void TearDown() override { toy::dawdle_at_most = 0; }

  const Registry registry_ = toy::registry();
  GraphBuilder b_{registry_};
  RunOptions options_;
};

std::vector<std::string> keys(const RunResult::Output& output) {
  std::vector<std::string> all;
  for (const auto& item : output.items) all.push_back(item.key);
  return all;
}

TEST_P(ExecutorTest, CollectsInTheOrderOfTheSource) {
  toy::dawdle_at_most = 3000;
  options_.threads = 4;
  b_.output("all", b_.add("map", "toy.map", {b_.add("source", "toy.source", {}, {{"to", 12}})}));
  const auto result = go();
  EXPECT_TRUE(result.output("all").stream);
  EXPECT_THAT(keys(result.output("all")),
              ElementsAre("u0", "u1", "u2", "u3", "u4", "u5", "u6", "u7", "u8", "u9", "u10", "u11"));
  EXPECT_THROW(result.output("al"), std::out_of_range);
}

TEST_P(ExecutorTest, ANothingPassesAJoinAndAnOptionalInput) {
  const int source = b_.add("source", "toy.source", {}, {{"to", 40}});
  const int strict = b_.add("strict", "toy.join", {source, Graph::Port{source, 1}});
  const int lax = b_.add("lax", "toy.join", {source, source, Graph::Port{source, 1}});
  b_.output("strict", strict);
  b_.output("lax", lax);
  const auto result = go();
  const auto some = result.nodes[static_cast<std::size_t>(source)].out[1].values;
  EXPECT_LT(some, 40u);
  EXPECT_GT(some, 0u);
  EXPECT_EQ(result.output("strict").items.size(), some);
  EXPECT_EQ(result.nodes[static_cast<std::size_t>(strict)].skipped, 40 - some);
  EXPECT_EQ(result.output("lax").items.size(), 40u);
}

TEST_P(ExecutorTest, TrainThenApplyWithOneItemInFlight) {
  const int source = b_.add("source", "toy.source", {}, {{"to", 50}});
  const int features = b_.add("features", "toy.map", {source});
  const int model = b_.add("model", "toy.train", {features});
  b_.output("applied", b_.add("apply", "toy.join", {features, model, source}));
  options_.in_flight = 1;
  EXPECT_EQ(go().output("applied").items.size(), 50u);
}

TEST_P(ExecutorTest, TwoDomainsThatCollectEachOtherDoNotLockUp) {
  const int one = b_.add("one", "toy.constant");
  const int d = b_.add("d", "toy.source", {}, {{"to", 30}});
  const int e = b_.add("e", "toy.source", {}, {{"to", 30}});
  const int x = b_.add("x", "toy.map", {d});
  const int y = b_.add("y", "toy.map", {e});
  b_.output("z", b_.add("z", "toy.apply", {one, y, x}));
  b_.output("w", b_.add("w", "toy.apply", {one, x, y}));
  options_.in_flight = 1;
  const auto result = go();
  EXPECT_EQ(result.output("z").items.size(), 30u);
  EXPECT_EQ(result.output("w").items.size(), 30u);
}

TEST_P(ExecutorTest, AnEmptyStreamTrainsFromNothing) {
  const int source = b_.add("source", "toy.source", {}, {{"to", 0}});
  b_.output("model", b_.add("train", "toy.train", {source}));
  b_.output("items", b_.add("map", "toy.map", {source}));
  const auto result = go();
  EXPECT_TRUE(result.output("model").value);
  EXPECT_TRUE(result.output("items").items.empty());
}

TEST_P(ExecutorTest, ASourceIsMadeFromAnotherDomainsResult) {
  const int source = b_.add("source", "toy.source");
  const int states = b_.add("states", "toy.states", {b_.add("map", "toy.map", {source})});
  const int trained = b_.add("trained", "toy.apply", {b_.add("c", "toy.constant"), source, states});
  b_.output("trained", trained);
  const auto result = go();
  EXPECT_EQ(result.output("trained").items.size(), result.nodes[static_cast<std::size_t>(states)].calls);
}

TEST_P(ExecutorTest, NamedSingleValuesAreCollectedInTheirOrder) {
  const int a = b_.add("a", "toy.constant", {}, {{"bits", 5}});
  const int c = b_.add("b", "toy.constant", {}, {{"bits", 6}});
  b_.output("one", b_.add("train", "toy.train", {In({{"first", Graph::Port{a}}, {"second", Graph::Port{c}}})}));
  const Mark expected{toy::mix(11, Collected<Mark>{{"first", {5}}, {"second", {6}}})};
  EXPECT_EQ(go().output("one").value.get<Mark>().bits, expected.bits);
}

TEST_P(ExecutorTest, AnErrorNamesNodeItemAndPlace) {
  const int source = b_.add("source", "toy.source");
  b_.output("out", b_.add("track", "toy.fail_at", {source}, {{"key", "u7"}}));
  const auto e = error();
  EXPECT_EQ(e.failure.node, "track");
  EXPECT_EQ(e.failure.item, "u7");
  EXPECT_STREQ(e.what(), "test.json:2:5: error: node \"track\", item \"u7\": the picture is black");
}

TEST_P(ExecutorTest, NoTwoCallsWriteTheSameFile) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  const int source = b_.add("source", "toy.source", {}, {{"to", 1}});
  b_.add("one", "toy.write", {source});
  b_.add("two", "toy.write", {b_.add("map", "toy.map", {source})});
  const auto clash = [](const std::string& second, const std::string& first) {
    return HasSubstr("node \"" + second + "\", item \"u0\": out/u0.txt is written by node \"" + first +
                     "\", item \"u0\" already");
  };
  for (Cache* const kept : {static_cast<Cache*>(nullptr), &cache, &cache}) {
    options_.cache = kept;
    options_.folder = folder.path() / "run";
    EXPECT_THAT(error().what(), testing::AnyOf(clash("two", "one"), clash("one", "two")));
    options_.keep_going = true;
    options_.folder = folder.path() / "kept going";
    EXPECT_EQ(go().failures.size(), 1u);
    options_.keep_going = false;
  }
}

TEST_P(ExecutorTest, AFoundFileClashesWithAnother) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  options_.cache = &cache;
  options_.keep_going = true;
  for (const char* const node : {"one", "two"}) {
    GraphBuilder alone(registry_);
    const int source = alone.add("source", "toy.source", {}, {{"to", 3}});
    alone.add(node, "toy.write", {node == std::string("one") ? source : alone.add("map", "toy.map", {source})});
    options_.folder = folder.path() / node;
    run(alone.graph, options_);
  }
  const int source = b_.add("source", "toy.source", {}, {{"to", 3}});
  const int one = b_.add("one", "toy.write", {source});
  const int two = b_.add("two", "toy.write", {b_.add("map", "toy.map", {source})});
  options_.folder = folder.path() / "both";
  const auto result = go();
  const auto& nodes = result.nodes;
  EXPECT_EQ(nodes[static_cast<std::size_t>(one)].loaded + nodes[static_cast<std::size_t>(two)].loaded, 6u);
  EXPECT_EQ(result.failures.size(), 3u);
  for (const auto& failure : result.failures)
    EXPECT_EQ(folder.read("both/out/" + failure.item + ".txt"),
              folder.read((failure.node == "one" ? "two/out/" : "one/out/") + failure.item + ".txt"))
        << "the first stays";
}

TEST_P(ExecutorTest, FilesAreWholeWithAndWithoutACache) {
  const test::TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  b_.add("write", "toy.write", {b_.add("source", "toy.source", {}, {{"to", 3}})});
  for (Cache* const kept : {static_cast<Cache*>(nullptr), &cache}) {
    options_.cache = kept;
    options_.folder = folder.path() / (kept ? "kept" : "plain");
    go();
  }
  for (const char* const item : {"u0", "u1", "u2"}) {
    const std::string name = std::string("/out/") + item + ".txt";
    EXPECT_NE(folder.read("plain" + name), "");
    EXPECT_EQ(folder.read("plain" + name), folder.read("kept" + name));
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path() / "plain"), {}), 1) << "no desk is left";
}

TEST_P(ExecutorTest, KeepsGoingAndListsWhatFailed) {
  options_.keep_going = true;
  const int source = b_.add("source", "toy.source");
  const int one = b_.add("one", "toy.fail_at", {source}, {{"key", "u7"}});
  const int two = b_.add("two", "toy.fail_at", {one}, {{"key", "u2"}});
  b_.output("out", b_.add("map", "toy.map", {two}));
  const auto result = go();
  EXPECT_THAT(keys(result.output("out")), ElementsAre("u0", "u1", "u3", "u4", "u5", "u6", "u8", "u9"));
  ASSERT_EQ(result.failures.size(), 2u);
  EXPECT_EQ(result.failures[0].node, "one");
  EXPECT_EQ(result.failures[0].item, "u7");
  EXPECT_EQ(result.failures[1].node, "two");
  EXPECT_EQ(result.nodes[static_cast<std::size_t>(two)].skipped, 1u);
}

// Nodes in a line with a failure, a dropped item and an absent optional input in the middle; what the line makes on the
// way is collected, and read again in a later sweep.
TEST_P(ExecutorTest, ALineOfNodesMayFailDropAndBeReadFromTheSide) {
  options_.keep_going = true;
  options_.threads = 4;
  const int source = b_.add("source", "toy.source", {}, {{"to", 200}});
  const int first = b_.add("first", "toy.map", {source});
  const int fails = b_.add("fails", "toy.fail_at", {first}, {{"key", "u7"}});
  const int drops = b_.add("drops", "toy.drop", {fails});
  const int joins = b_.add("joins", "toy.join", {fails, source, drops});
  const int last = b_.add("last", "toy.map", {joins});
  const int model = b_.add("model", "toy.train", {drops});
  b_.output("last", last);
  b_.output("later", b_.add("later", "toy.join", {first, model, drops}));
  const auto result = go();
  EXPECT_EQ(result.output("last").items.size(), 199u);
  EXPECT_EQ(result.output("later").items.size(), 200u);
  const auto stats = [&](int n) { return result.nodes[static_cast<std::size_t>(n)]; };
  EXPECT_EQ(stats(fails).failed, 1u);
  EXPECT_EQ(stats(drops).skipped, 1u);
  EXPECT_EQ(stats(joins).skipped, 1u);
  EXPECT_LT(stats(drops).out[0].values, 199u);
  EXPECT_EQ(stats(model).in[0], stats(drops).out[0]);
  RunOptions other = options_;
  other.executor = options_.executor == Executor::flow ? Executor::serial : Executor::flow;
  const auto again = run(b_.graph, other);
  for (const char* name : {"last", "later"})
    for (std::size_t i = 0; i < result.output(name).items.size(); ++i) {
      ASSERT_EQ(result.output(name).items[i].key, again.output(name).items.at(i).key);
      ASSERT_EQ(result.output(name).items[i].value.get<Mark>().bits,
                again.output(name).items[i].value.get<Mark>().bits);
    }
}

TEST_P(ExecutorTest, ItemsInALineRunBesideEachOther) {
  if (GetParam() == Executor::serial) GTEST_SKIP() << "the serial executor runs one at a time";
  std::atomic<bool> cancel{false};
  options_.cancel = &cancel;
  struct Busy : RunObserver {
    explicit Busy(std::atomic<bool>& c) : cancel(c) {}
    void call_started(int node, const std::string&) override {
      if (node == 2 && ++at_work == 2) cancel = true;
    }
    std::atomic<bool>& cancel;
    std::atomic<int> at_work{0};
  } busy(cancel);
  options_.observers = {&busy};
  const int source = b_.add("source", "toy.source");
  b_.output("out", b_.add("endless", "toy.endless", {b_.add("map", "toy.map", {source})}));
  EXPECT_THROW(go(), Cancelled);  // ends only if two items are at the endless node
  EXPECT_EQ(busy.at_work, 2);
}

TEST_P(ExecutorTest, AKeyThatComesTwiceIsAnError) {
  b_.output("out", b_.add("map", "toy.map", {b_.add("source", "toy.twice")}));
  const auto e = error();
  EXPECT_EQ(e.failure.node, "source");
  EXPECT_EQ(e.failure.item, "a");
  options_.keep_going = true;
  EXPECT_THAT(keys(go().output("out")), ElementsAre("a", "b", "c"));
}

TEST_P(ExecutorTest, ASourceThatBreaksOffSaysAfterWhichItem) {
  b_.output("out", b_.add("map", "toy.map", {b_.add("source", "toy.break_off")}));
  EXPECT_THAT(error().what(), HasSubstr("node \"source\": the item after \"u2\": the disk is gone"));
  options_.keep_going = true;
  EXPECT_EQ(go().output("out").items.size(), 3u);
}

TEST_P(ExecutorTest, KeepsGoingBehindAnItemThatASourceCannotMake) {
  b_.output("out", b_.add("map", "toy.map", {b_.add("source", "toy.gap")}));
  EXPECT_THAT(error().what(), HasSubstr("the item after \"u0\": u1 is damaged"));
  options_.keep_going = true;
  const auto result = go();
  EXPECT_THAT(keys(result.output("out")), ElementsAre("u0", "u2", "u3", "u4"));
  EXPECT_EQ(result.failures.size(), 1u);
}

TEST_P(ExecutorTest, CancelStopsRunningNodes) {
  b_.output("out", b_.add("endless", "toy.endless", {b_.add("source", "toy.source")}));
  std::atomic<bool> cancel{false};
  options_.cancel = &cancel;
  std::jthread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    cancel = true;
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(go(), Cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_P(ExecutorTest, CancelStopsBetweenItems) {
  toy::dawdle_at_most = 2000;
  b_.output("out", b_.add("map", "toy.map", {b_.add("source", "toy.source", {}, {{"to", 1000000}})}));
  std::atomic<bool> cancel{false};
  options_.cancel = &cancel;
  std::jthread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    cancel = true;
  });
  EXPECT_THROW(go(), Cancelled);
}

TEST_P(ExecutorTest, AFailureStopsNodesThatAreStillRunning) {
  if (GetParam() == Executor::serial) GTEST_SKIP() << "the serial executor runs one at a time";
  const int source = b_.add("source", "toy.source");
  b_.output("a", b_.add("endless", "toy.endless", {b_.add("c", "toy.constant")}));
  b_.output("b", b_.add("fail", "toy.fail_at", {source}, {{"key", "u3"}}));
  EXPECT_EQ(error().failure.node, "fail");
}

/// Writes down what a run tells.
struct Listener : RunObserver {
  void call_started(int node, const std::string& item) override { note("start", node, item); }
  void call_ended(int node, const std::string& item) override { note("end", node, item); }
  void item_done(int node, const std::string& item) override { note("done", node, item); }
  void log(int node, const std::string& item, std::string_view message) override {
    note(std::string(message), node, item);
  }
  void failed(const Failure&) override { note("failed", -1, ""); }
  void ended(const RunReport& report) override { error = report.error; }
  void note(const std::string& what, int node, const std::string& item) {
    const std::lock_guard lock(mutex);
    heard.push_back(what + " " + std::to_string(node) + item);
  }
  std::mutex mutex;
  std::vector<std::string> heard;
  std::string error;
};

TEST_P(ExecutorTest, ObserversHearOfCallsAndOfTheEnd) {
  const int source = b_.add("source", "toy.source", {}, {{"to", 1}});
  b_.output("out", b_.add("fail", "toy.fail_at", {source}, {{"key", "u0"}}));
  Listener listener;
  options_.observers = {&listener};
  options_.keep_going = true;
  go();
  EXPECT_THAT(listener.heard,
              testing::IsSupersetOf({"done 0u0", "start 1u0", "looking 1u0", "end 1u0", "done 1u0", "failed -1"}));
  EXPECT_EQ(listener.error, "");
  listener.heard.clear();
  options_.keep_going = false;
  EXPECT_THROW(go(), RunError);
  EXPECT_THAT(listener.heard, testing::Not(testing::Contains("failed -1")));
  EXPECT_THAT(listener.error, HasSubstr("item \"u0\""));
}

TEST_P(ExecutorTest, ManyCheapItems) {
  int last = b_.add("source", "toy.source", {}, {{"to", 100000}});
  for (const char* name : {"a", "b", "c", "d"}) last = b_.add(name, "toy.map", {last});
  b_.output("sum", b_.add("train", "toy.train", {last}));
  const auto start = std::chrono::steady_clock::now();
  const auto result = go();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_EQ(result.nodes.back().in[0], (PortCount{100000, 100000}));
  RecordProperty("seconds", std::to_string(result.wall));
}

TEST_P(ExecutorTest, RefusesImpossibleOptions) {
  options_.threads = 0;
  EXPECT_THROW(go(), std::invalid_argument);
  options_ = {};
  options_.in_flight = -1;
  EXPECT_THROW(go(), std::invalid_argument);
}

TEST_P(ExecutorTest, BooksThatDoNotBalanceNameTheNode) {
  b_.output("out", b_.add("map", "toy.map", {b_.add("source", "toy.source")}));
  auto stats = go().nodes;
  EXPECT_NO_THROW(check_books(b_.graph, stats));
  stats[1].in[0].items -= 1;
  EXPECT_THROW(
      {
        try {
          check_books(b_.graph, stats);
        } catch (const std::logic_error& e) {
          EXPECT_THAT(e.what(), HasSubstr("node \"map\""));
          throw;
        }
      },
      std::logic_error);
}

INSTANTIATE_TEST_SUITE_P(Both, ExecutorTest, testing::Values(Executor::flow, Executor::serial),
                         [](const auto& info) { return info.param == Executor::flow ? "Flow" : "Serial"; });

}  // namespace
}  // namespace talkgraph
