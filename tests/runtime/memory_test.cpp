#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "runtime/executor.h"
#include "tests/runtime/graph_builder.h"
#include "tests/runtime/toy_nodes.h"

namespace talkgraph {

namespace toy {

constexpr std::size_t block_bytes = 10'000'000;
inline std::atomic<std::size_t> live_blocks{0}, most_blocks{0};
inline bool real_memory = false;

/// 10 MB, counted; really taken only where the test asks for it.
struct Block {
  struct Counted {
    Counted() {
      const auto live = ++live_blocks;
      for (auto most = most_blocks.load(); live > most && !most_blocks.compare_exchange_weak(most, live);) {
      }
      if (real_memory) bytes.assign(block_bytes, 'x');
    }
    ~Counted() { --live_blocks; }
    std::string bytes;
  };
  std::shared_ptr<const Counted> data;
};
inline void fields(Archive&, Block&) {}

}  // namespace toy

template <>
inline constexpr PortType port_type<toy::Block>{"Block", 1};

namespace toy {

struct BlockSource {
  int to = 1;
  Stream<Block> operator()() const {
    return Stream<Block>([to = to, i = 0]() mutable -> std::optional<Item<Block>> {
      if (i == to) return {};
      return Item<Block>{std::to_string(i++), {std::make_shared<const Block::Counted>()}};
    });
  }
};
inline void describe(Description<BlockSource>& d) {
  d.type("toy.blocks").summary("blocks of 10 MB").output("block");
  d.param("to", &BlockSource::to);
}
struct BlockMap {
  Block operator()(const Block&, const Mark*) const {
    dawdle();
    return {std::make_shared<const Block::Counted>()};
  }
};
inline void describe(Description<BlockMap>& d) {
  d.type("toy.block_map").summary("a new block").input("in").input("model").output("out");
}
struct BlockMark {
  Mark operator()(const Block&) const { return {1}; }
};
inline void describe(Description<BlockMark>& d) { d.type("toy.block_mark").summary("small").input("in").output("out"); }
struct BlockTrain {
  Mark operator()(const Collected<Block>& all) const { return {all.size()}; }
};
inline void describe(Description<BlockTrain>& d) {
  d.type("toy.block_train").summary("collects blocks").input("all").output("model");
}

}  // namespace toy

namespace {

class MemoryTest : public testing::Test {
 protected:
  MemoryTest() {
    registry_.add<toy::BlockSource>();
    registry_.add<toy::BlockMap>();
    registry_.add<toy::BlockMark>();
    registry_.add<toy::BlockTrain>();
    toy::most_blocks = 0;
    toy::real_memory = false;
  }
  /// A stream of blocks through five nodes.
  void five_nodes(int items) {
    int last = b_.add("source", "toy.blocks", {}, {{"to", items}});
    for (const char* name : {"a", "b", "c", "d"}) last = b_.add(name, "toy.block_map", {last});
    b_.output("marks", b_.add("e", "toy.block_mark", {last}));
  }

  Registry registry_ = toy::registry();
  GraphBuilder b_{registry_};
};

/// The most memory since it was reset, bytes.
std::size_t peak(bool reset = false) {
  if (reset) std::ofstream("/proc/self/clear_refs") << "5";
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoul(line.substr(6)) * 1024;
  return 0;
}

TEST_F(MemoryTest, TenThousandItemsOfTenMegabytesStayUnder300) {
  five_nodes(10000);
  EXPECT_EQ(run(b_.graph).output("marks").items.size(), 10000u);
  EXPECT_LT(toy::most_blocks * toy::block_bytes, 300'000'000u);
  EXPECT_EQ(toy::live_blocks, 0u);
}

TEST_F(MemoryTest, RealMemoryStaysUnder300) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps freed memory back";
#endif
  toy::real_memory = true;
  five_nodes(150);
  const auto before = peak(true);
  run(b_.graph);
  const auto used = peak() - before;
  EXPECT_GT(used, toy::block_bytes);  // else nothing was measured
  EXPECT_LT(used, 300'000'000u);
  RecordProperty("megabytes", std::to_string(used / 1'000'000));
}

// A source waits for a model that is trained on another stream.
TEST_F(MemoryTest, AStreamIsNotHeldForTheSakeOfAnotherOne) {
  const int test = b_.add("test", "toy.blocks", {}, {{"to", 1000}});
  const int marks = b_.add("marks", "toy.block_mark", {b_.add("training", "toy.blocks", {}, {{"to", 1000}})});
  const int model = b_.add("model", "toy.train", {marks});
  b_.output("out", b_.add("mark", "toy.block_mark", {b_.add("apply", "toy.block_map", {test, model})}));
  EXPECT_EQ(run(b_.graph).output("out").items.size(), 1000u);
  EXPECT_LE(toy::most_blocks, 30u);
}

TEST_F(MemoryTest, WhatIsHeldForALaterSweepIsGivenBack) {
  const int source = b_.add("source", "toy.blocks", {}, {{"to", 100}});
  const int mapped = b_.add("map", "toy.block_map", {source});
  const int model = b_.add("model", "toy.block_train", {mapped});
  const int applied = b_.add("apply", "toy.block_map", {mapped, model});
  b_.output("out", b_.add("mark", "toy.block_mark", {applied}));
  RunOptions options;
  options.in_flight = 1;
  run(b_.graph, options);
  EXPECT_LE(toy::most_blocks, 102u);  // the mapped ones, and those of the item at work
  EXPECT_EQ(toy::live_blocks, 0u);
}

}  // namespace
}  // namespace talkgraph
