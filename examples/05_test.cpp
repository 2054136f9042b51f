// 5. Tests make the struct and call it. What graphs do with nodes is tested in talkgraph itself.
#include <gtest/gtest.h>

#include "01_first_node.h"
#include "02_parameters.h"
#include "03_training.h"
#include "04_source.h"

namespace mine {
namespace {

/// One dimension at 25 frames per second.
Track track(std::vector<double> values) {
  Track out;
  out.values = Eigen::Map<Eigen::VectorXd>(values.data(), std::ssize(values));
  return out;
}

TEST(Loudness, OfAFullSineIsThreeDecibelsBelowFullScale) {
  Audio tone;
  tone.samples = Eigen::VectorXd::LinSpaced(16000, 0, 15999).unaryExpr([](double n) {
    return std::sin(2 * std::numbers::pi * n / 160);
  });
  const Track level = Loudness{}(tone);
  ASSERT_EQ(level.frames(), 100);
  EXPECT_NEAR(level.values.minCoeff(), -3.01, 0.01);
  EXPECT_NEAR(level.values.maxCoeff(), -3.01, 0.01);
}

TEST(Loudness, RefusesWhatIsNoSound) {
  Audio audio;
  audio.rate = 50;
  EXPECT_THROW(Loudness{}(audio), std::runtime_error);
}

TEST(Scale, CutsOffWhatLiesOutside) {
  const Track out = Scale{-60, -20}(track({-90, -60, -40, 0}));
  EXPECT_EQ(out.values, track({0, 0, 0.5, 1}).values);
}

TEST(Smooth, SpreadsAFrameOverItsNeighbours) {
  const Track click = track({0, 0, 1, 0, 0});
  EXPECT_NEAR((Smooth{0.08, Window::box}(click).values(1)), 1 / 3.0, 1e-12);
  EXPECT_NEAR((Smooth{0.08, Window::triangle}(click).values(1)), 1 / 4.0, 1e-12);
  EXPECT_NEAR((Smooth{0.08, Window::triangle}(click).values(2)), 1 / 2.0, 1e-12);
}

TEST(LearnJaw, FindsTheLineThatTheJawFollows) {
  const Track a = track({0, 1, 2}), b = track({4, 8, 6});
  const auto jaw = [](Track t) { return t.values = (t.values.array() * 3 + 1).matrix(), t; };
  const JawModel model = LearnJaw{}({{"a", a}, {"b", b}, {"without a jaw", b}}, {{"b", jaw(b)}, {"a", jaw(a)}});
  EXPECT_NEAR(model.gain, 3, 1e-12);
  EXPECT_NEAR(model.offset, 1, 1e-12);
  EXPECT_NEAR((MoveJaw{}(a, model).values - jaw(a).values).norm(), 0, 1e-12);
  EXPECT_THROW(LearnJaw{}({}, {}), std::runtime_error);
}

TEST(Babble, MakesAsManyRecordingsAsAsked) {
  Random random;
  auto stream = Babble{3, 1}(random);
  std::vector<std::string> keys;
  while (const auto item = stream.next()) {
    keys.push_back(item->key);
    EXPECT_EQ(item->value.sound.samples.size(), 16000);
    EXPECT_EQ(item->value.jaw.frames(), 25);
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"babble0", "babble1", "babble2"}));
}

}  // namespace
}  // namespace mine
