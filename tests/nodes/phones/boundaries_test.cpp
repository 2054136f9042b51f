#include "nodes/phones/boundaries.h"

#include <gtest/gtest.h>

#include <cmath>

#include "graph/random.h"

namespace talkgraph {
namespace {

/// A hum up to a time, noise from there on.
Audio hum_then_noise(double change, double gain = 1) {
  Random random(1, "boundaries", "noise");
  Audio audio{Eigen::VectorXd(8000), 16000};
  for (Eigen::Index i = 0; i < audio.samples.size(); ++i) {
    const double t = static_cast<double>(i) / audio.rate;
    audio.samples[i] = gain * (t < change ? 0.3 * std::sin(2 * M_PI * 200 * t) : 0.1 * random.normal());
  }
  return audio;
}

const std::vector<FrameSpan> kVowelAndFricative = {{"AA", 0, 20}, {"S", 20, 48}};  // the model's boundary: 0.2078 s

TEST(Boundaries, MoveToWhereTheSpectrumChanges) {
  for (const double change : {0.195, 0.2, 0.2078, 0.215, 0.22})
    for (const double gain : {1.0, 1e-3}) {
      const auto starts = phone_starts(kVowelAndFricative, hum_then_noise(change, gain));
      ASSERT_EQ(starts.size(), 2u);
      EXPECT_EQ(starts[0], 0);
      EXPECT_NEAR(starts[1], change, 0.005) << gain;
    }
}

TEST(Boundaries, MoveNoFurtherThan20Milliseconds) {
  EXPECT_NEAR(phone_starts(kVowelAndFricative, hum_then_noise(0.3))[1], 0.2078, 0.0201);
  EXPECT_NEAR(phone_starts(kVowelAndFricative, hum_then_noise(0.1))[1], 0.2078, 0.0201);
}

TEST(Boundaries, StayBetweenVowels) {
  const Audio audio = hum_then_noise(0.2);
  for (const char* before : {"AA", "M", "L", "B"})
    EXPECT_DOUBLE_EQ(phone_starts({{before, 0, 20}, {"IY", 20, 48}}, audio)[1], sphinx_boundary(20)) << before;
  EXPECT_NE(phone_starts({{"S", 0, 20}, {"IY", 20, 48}}, audio)[1], sphinx_boundary(20));
}

TEST(Boundaries, StayInOrderBetweenShortPhones) {
  const std::vector<FrameSpan> phones = {{"S", 0, 18}, {"T", 18, 21}, {"S", 21, 24}, {"T", 24, 48}};
  const auto starts = phone_starts(phones, hum_then_noise(0.22));
  for (std::size_t i = 1; i < starts.size(); ++i) EXPECT_GT(starts[i], starts[i - 1]);
}

TEST(Boundaries, AShortPauseBeforeAStopIsItsClosure) {
  const Audio silence{Eigen::VectorXd::Zero(8000), 16000};
  const auto starts = [&](int pause, const char* phone) {
    return phone_starts({{"AA", 0, 10}, {"SIL", 10, 10 + pause}, {phone, 10 + pause, 48}}, silence);
  };
  EXPECT_EQ(starts(8, "P")[2], starts(8, "P")[1]);
  EXPECT_GT(starts(14, "P")[2], starts(14, "P")[1]);
  EXPECT_GT(starts(8, "S")[2], starts(8, "S")[1]);
  EXPECT_GT(phone_starts({{"SIL", 0, 6}, {"P", 6, 48}}, silence)[1], 0) << "before the first phone it is a pause";
}

TEST(Boundaries, OfNothingAndBeyondTheEnd) {
  const Audio audio = hum_then_noise(0.2);
  EXPECT_TRUE(phone_starts({}, audio).empty());
  EXPECT_LE(phone_starts({{"AA", 0, 20}, {"S", 80, 90}}, audio)[1], audio.seconds());
}

}  // namespace
}  // namespace talkgraph
