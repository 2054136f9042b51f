#include <gtest/gtest.h>

#include "runtime/executor.h"
#include "runtime/plan.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

/// Graphs of every shape the language allows, made by chance from a seed.
class RandomGraph {
 public:
  RandomGraph(const Registry& registry, std::uint64_t seed) : random_(seed), builder_(registry) {
    builder_.graph.seed = seed;
    add(builder_.add("source0", "toy.source", {}, {{"to", random_.below(30)}}));
    add(builder_.add("constant", "toy.constant", {}, {{"bits", random_.below(1000)}}));
    const auto count = 3 + random_.below(22);
    for (std::uint64_t i = 0; i < count; ++i) grow("n" + std::to_string(i));
    for (std::size_t p = 0; p < ports_.size(); ++p)
      if (random_.below(3) == 0 || p + 2 > ports_.size()) builder_.output("out" + std::to_string(p), ports_[p]);
  }
  const Graph& graph() const { return builder_.graph; }

 private:
  using In = GraphBuilder::In;

  void add(int node) {
    const auto outputs = builder_.graph.nodes[static_cast<std::size_t>(node)].type->outputs.size();
    for (std::size_t p = 0; p < outputs; ++p) ports_.push_back({node, static_cast<int>(p)});
  }
  template <class Want>
  std::optional<Graph::Port> any(Want want) {
    std::vector<Graph::Port> fitting;
    for (const auto& p : ports_)
      if (want(builder_.domain_of(p))) fitting.push_back(p);
    if (fitting.empty()) return {};
    return fitting[random_.below(fitting.size())];
  }
  Graph::Port single() {
    return *any([](int d) { return d < 0; });
  }
  Graph::Port stream() {
    return *any([](int d) { return d >= 0; });
  }
  Graph::Port item_or_single(int domain) {
    return *any([&](int d) { return d < 0 || d == domain; });
  }
  In maybe(Graph::Port p) { return random_.below(2) ? In(p) : In(); }
  In collected() {
    if (random_.below(5)) return In(stream());
    std::vector<std::pair<std::string, Graph::Port>> named;
    for (std::uint64_t i = random_.below(3); i-- > 0;) named.emplace_back("name" + std::to_string(i), single());
    return In(named);
  }

  void grow(const std::string& name) {
    const Graph::Port main = random_.below(5) ? stream() : single();
    const int domain = builder_.domain_of(main);
    switch (random_.below(11)) {
      case 0:
        return add(builder_.add(name, "toy.map", {main}, {{"k", random_.below(9)}}));
      case 1:
        return add(builder_.add(name, "toy.drop", {main}));
      case 2:
      case 3:
      case 4:
        return add(builder_.add(name, "toy.join", {main, item_or_single(domain), maybe(item_or_single(domain))}));
      case 5:
        return add(builder_.add(name, "toy.train", {collected(), maybe(single())}));
      case 6:
        return add(builder_.add(name, "toy.maybe_train", {collected()}));
      case 7:
      case 8:
        return add(builder_.add(name, "toy.apply", {single(), collected(), main}));
      case 9:
        return add(random_.below(2) ? builder_.add(name, "toy.states", {collected(), maybe(single())})
                                    : builder_.add(name, "toy.from_one", {single()}));
      default:
        return add(builder_.add(name, "toy.source", {}, {{"to", random_.below(12)}}));
    }
  }

  Random random_;
  GraphBuilder builder_;
  std::vector<Graph::Port> ports_;
};

/// The outputs as text.
std::string results(const RunResult& result) {
  std::string text;
  const auto put = [&](const std::string& key, const Value& v) {
    text += key + "=" + (v ? std::to_string(v.get<Mark>().bits) : "nothing") + " ";
  };
  for (const auto& output : result.outputs) {
    text += "\n" + output.name + ": ";
    if (!output.stream) put("", output.value);
    for (const auto& item : output.items) put(item.key, item.value);
  }
  return text;
}

/// With the books.
std::string fingerprint(const RunResult& result) {
  std::string text = results(result);
  for (const auto& node : result.nodes) {
    text += "\n" + std::to_string(node.calls) + " calls, skipped " + std::to_string(node.skipped);
    for (const auto& c : node.in) text += " in " + std::to_string(c.items) + "/" + std::to_string(c.values);
    for (const auto& c : node.out) text += " out " + std::to_string(c.items) + "/" + std::to_string(c.values);
  }
  return text;
}

TEST(RandomGraphs, BothExecutorsGiveTheSameBits) {
  const Registry registry = toy::registry();
  std::size_t swept_again = 0, nothings = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const RandomGraph random(registry, seed);
    const Graph& graph = random.graph();
    toy::dawdle_at_most = 0;
    RunOptions serial;
    serial.executor = Executor::serial;
    const auto result = run(graph, serial);
    const auto expected = fingerprint(result);
    for (const auto& node : result.nodes) nothings += node.skipped;
    for (const auto& unit : make_plan(graph).units) swept_again += unit.domain >= 0 && !unit.opens;
    for (const int threads : {1, 2, 4}) {
      RunOptions flow;
      flow.threads = threads;
      flow.in_flight = static_cast<int>(seed % 4);  // 0: the default
      toy::dawdle_at_most = seed % 3 == 0 ? 200 : 0;
      ASSERT_EQ(fingerprint(run(graph, flow)), expected) << "seed " << seed << ", " << threads << " threads";
    }
  }
  toy::dawdle_at_most = 0;
  // The graphs did contain what is hard.
  EXPECT_GT(swept_again, 20u);
  EXPECT_GT(nothings, 100u);
}

// Kept are the results of types taken by chance; then some entries are lost, some damaged. Whatever lies in the cache,
// a run gives what it gives without one.
TEST(RandomGraphs, ACacheChangesNoResult) {
  const test::TemporaryFolder folder;
  const Registry all = toy::registry();
  std::uint64_t loaded = 0, unneeded = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random chance(seed);
    Registry registry;
    for (const auto& name : all.names()) {
      NodeType type = *all.find(name);
      type.stored = !type.makes_stream && chance.below(2);
      registry.add(type);
    }
    const RandomGraph random(registry, seed);
    const auto expected = results(run(random.graph()));
    Cache cache(folder.path() / std::to_string(seed));
    RunOptions options;
    options.cache = &cache;
    for (int round = 0; round < 4; ++round) {
      options.executor = chance.below(2) ? Executor::flow : Executor::serial;
      const auto result = run(random.graph(), options);
      ASSERT_EQ(results(result), expected) << "seed " << seed << ", round " << round;
      for (const auto& node : result.nodes) loaded += node.loaded, unneeded += node.unneeded;
      for (const auto& entry : cache.entries()) {
        const auto luck = chance.below(round == 0 ? 100 : 4);
        const std::string name = entry.key.str();
        if (luck == 0) cache.remove(entry.key);
        if (luck == 1) std::filesystem::resize_file(cache.folder() / name.substr(0, 2) / name / "entry.json", 20);
      }
    }
  }
  EXPECT_GT(loaded, 1000u);
  EXPECT_GT(unneeded, 1000u);
}

}  // namespace
}  // namespace talkgraph
