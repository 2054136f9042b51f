#include <gtest/gtest.h>

#include <map>

#include "nodes/all_nodes.h"
#include "runtime/executor.h"
#include "tests/nodes/speech/chains.h"
#include "tests/nodes/speech/written_out.h"
#include "tests/source_folder.h"

namespace talkgraph {

/// 1.3 s of a voice.
struct TestVoice {
  Audio operator()() const { return test::voice(1.3); }
};
static void describe(Description<TestVoice>& d) { d.type("test.voice").summary("a voice").output("audio", "1.3 s"); }

/// The same, silent from some time on.
struct CutVoice {
  double from = 1.3;  ///< seconds
  Audio operator()() const {
    Audio audio = test::voice(1.3);
    const auto left = std::min<Eigen::Index>(audio.samples.size(), std::lround(from * audio.rate));
    audio.samples.tail(audio.samples.size() - left).setZero();
    return audio;
  }
};
static void describe(Description<CutVoice>& d) {
  d.type("test.cut_voice").summary("a voice that stops").output("audio", "1.3 s");
  d.param("from", &CutVoice::from).doc("where it stops, seconds");
}

namespace cli {
namespace {

const std::filesystem::path folder = test::source("/pipelines/fragments/features");

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

Eigen::MatrixXd at_the_video_rate(const std::string& speech, double from) {
  Registry registry = all_nodes();
  registry.add<CutVoice>();
  Diagnostics diagnostics;
  const auto graph = load_graph_text(
      "g.json",
      R"({ "nodes": { "voice": { "type": "test.cut_voice", "params": { "from": )" + std::to_string(from) +
          R"( } }, "speech": { "graph": ")" + (folder.parent_path() / speech).string() +
          R"(", "in": { "audio": "voice" } } }, "outputs": { "track": "speech.track" } })",
      registry, diagnostics);
  if (!graph) throw std::runtime_error(diagnostics.str());
  return run(*graph).output("track").value.get<Track>().values;
}

// What speech as it comes is heard with: medians depend on no sound later than half a window after their frame.
TEST(FeaturesOnline, OfMediansLookAheadByHalfAWindow) {
  for (const int t : {4, 11, 20}) {
    const double end = (t + 1) / 25.0;
    const Eigen::MatrixXd whole = at_the_video_rate("speech-median.json", 1.3).topRows(t + 1);
    EXPECT_EQ(at_the_video_rate("speech-median.json", end + 0.0125).topRows(t + 1), whole);
    EXPECT_NE(at_the_video_rate("speech-median.json", end - 0.02).topRows(t + 1), whole);
    EXPECT_NE(at_the_video_rate("speech.json", end + 0.0125).topRows(t + 1),
              at_the_video_rate("speech.json", 1.3).topRows(t + 1))
        << "the polyphase filter sees further";
  }
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
