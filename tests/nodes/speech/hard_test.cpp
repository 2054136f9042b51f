#include <gtest/gtest.h>

#include <limits>

#include "tests/nodes/speech/chains.h"
#include "tests/nodes/speech/written_out.h"

namespace talkgraph {
namespace {

struct Chain {
  const char* name;
  Track (*compute)(const Audio&, const Frame&);
};
void PrintTo(const Chain& chain, std::ostream* out) { *out << chain.name; }

class HardInput : public testing::TestWithParam<Chain> {
 protected:
  Track at(const Audio& audio, const Frame& frame = {}) { return GetParam().compute(audio, frame); }
};

Audio sound(Eigen::VectorXd samples, double rate = 16000) {
  Audio a;
  a.samples = std::move(samples);
  a.rate = rate;
  return a;
}

TEST_P(HardInput, GivesFiniteNumbersAtEveryRate) {
  for (const double rate : {8000.0, 11025.0, 16000.0, 22050.0, 44100.0, 48000.0, 96000.0, 192000.0}) {
    const Audio voice = test::voice(0.2, rate);
    const auto n = voice.samples.size();
    const Eigen::VectorXd loud = 1000 * voice.samples;
    for (const Frame& frame : {Frame{}, Frame{.window = 0.05, .rate = Rational(30000, 1001), .centred = true}}) {
      const Track speech = at(voice, frame);
      EXPECT_GT(speech.frames(), 4);
      for (const auto& [name, samples] : std::vector<std::pair<const char*, Eigen::VectorXd>>{
               {"speech", voice.samples},
               {"silence", Eigen::VectorXd::Zero(n)},
               {"speech after silence", (Eigen::VectorXd(2 * n) << Eigen::VectorXd::Zero(n), voice.samples).finished()},
               {"clipping", loud.cwiseMax(-1).cwiseMin(1)},
               {"DC", Eigen::VectorXd::Ones(n)},
               {"impulse", Eigen::VectorXd::Unit(n, n / 2)},
               {"the least number", Eigen::VectorXd::Constant(n, std::numeric_limits<double>::denorm_min())},
               {"far above full scale", 1e90 * voice.samples},
               {"one sample", Eigen::VectorXd::Ones(1)},
               {"no sample", Eigen::VectorXd()}}) {
        const Track track = at(sound(samples, rate), frame);
        EXPECT_TRUE(track.values.allFinite()) << name << " at " << rate;
        EXPECT_EQ(track.dimension(), 20) << name;
        EXPECT_GE(track.frames(), 1) << name;
      }
    }
  }
}

TEST_P(HardInput, SilenceIsTheSameInEveryFrame) {
  const Track track = at(sound(Eigen::VectorXd::Zero(16000)));
  ASSERT_EQ(track.frames(), 98);
  EXPECT_LT((track.values.rowwise() - track.values.row(0)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(HardInput, RefusesNumbersThatAreNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Audio audio = test::noise(1000);
    audio.samples[500] = bad;
    try {
      at(audio);
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("NaN or infinite samples"), std::string::npos) << e.what();
    }
  }
}

TEST_P(HardInput, HasAsManyFramesAtAnyRate) {
  EXPECT_EQ(at(test::noise(22050, 22050)).frames(), at(test::noise(16000)).frames());
}

// A file is its frames one after the other: what comes later changes nothing.
TEST_P(HardInput, FramesDoNotDependOnWhatFollows) {
  const Audio whole = test::voice(2);
  const Track all = at(whole), part = at(sound(whole.samples.head(16000)));
  EXPECT_LT((all.values.topRows(part.frames()) - part.values).cwiseAbs().maxCoeff(), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Chains, HardInput,
                         testing::Values(Chain{"mfcc", test::mfcc}, Chain{"plp", test::plp},
                                         Chain{"plp_bark", test::plp_bark}, Chain{"rasta_plp", test::rasta_plp},
                                         Chain{"lpc", test::lpc}, Chain{"lsf", test::lsf},
                                         Chain{"reflection", test::reflection}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace talkgraph
