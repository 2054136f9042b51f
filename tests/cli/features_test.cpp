#include <gtest/gtest.h>

#include <map>

#include "nodes/all_nodes.h"
#include "runtime/executor.h"
#include "tests/nodes/speech/chains.h"
#include "tests/nodes/speech/written_out.h"

namespace talkgraph {

/// 1.3 s of a voice.
struct TestVoice {
  Audio operator()() const { return test::voice(1.3); }
};
static void describe(Description<TestVoice>& d) { d.type("test.voice").summary("a voice").output("audio", "1.3 s"); }

namespace cli {
namespace {

const std::filesystem::path folder = TALKGRAPH_SOURCE_DIR "/pipelines/fragments/features";

std::vector<std::string> fragments() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().stem().string());
  return names;
}

class Features : public testing::TestWithParam<std::string> {
 protected:
  Track run_with(const std::string& parameters) {
    Registry registry = all_nodes();
    registry.add<TestVoice>();
    Diagnostics diagnostics;
    const auto graph =
        load_graph_text("g.json",
                        R"({ "nodes": { "voice": { "type": "test.voice" }, "features": { "graph": ")" +
                            (folder / GetParam()).string() + R"(.json", "in": { "audio": "voice" }, "params": )" +
                            parameters + R"( } }, "outputs": { "track": "features.track" } })",
                        registry, diagnostics);
    if (!graph) throw std::runtime_error(diagnostics.str());
    return run(*graph).output("track").value.get<Track>();
  }
  /// What the nodes' own tests hold to its formulas.
  void expect_chain(const Track& track, const Frame& frame) {
    const std::map<std::string, Track (*)(const Audio&, const Frame&)> chains = {
        {"mfcc", test::mfcc}, {"plp", test::plp}, {"plp-bark", test::plp_bark},    {"rasta-plp", test::rasta_plp},
        {"lpc", test::lpc},   {"lsf", test::lsf}, {"reflection", test::reflection}};
    const auto chain = chains.find(GetParam());
    if (chain != chains.end()) {
      EXPECT_EQ(track.values, chain->second(test::voice(1.3), frame).values);
    }
  }
};

TEST_P(Features, AreTwentyAHundredTimesASecond) {
  const Track track = run_with("{}");
  EXPECT_EQ(track.dimension(), 20);
  EXPECT_EQ(track.names.size(), 20u);
  EXPECT_EQ(track.frames(), 128);
  EXPECT_EQ(track.rate, Rational(100));
  EXPECT_DOUBLE_EQ(track.start, 0.0125);
  EXPECT_TRUE(track.values.allFinite());
  expect_chain(track, {});
}

TEST_P(Features, ComeStraightAtTheVideoRate) {
  const Track track = run_with(R"({ "rate": "30000/1001", "window": 0.05, "centred": true })");
  EXPECT_EQ(track.dimension(), 20);
  EXPECT_EQ(track.frames(), 39);
  EXPECT_EQ(track.rate, Rational(30000, 1001));
  EXPECT_DOUBLE_EQ(track.start, 1001 / 60000.0);
  EXPECT_TRUE(track.values.allFinite());
  expect_chain(track, {.window = 0.05, .rate = Rational(30000, 1001), .centred = true});
}

INSTANTIATE_TEST_SUITE_P(Fragments, Features, testing::ValuesIn(fragments()), [](const auto& info) {
  std::string name = info.param;
  for (auto& c : name)
    if (c == '-') c = '_';
  return name;
});

}  // namespace
}  // namespace cli
}  // namespace talkgraph
