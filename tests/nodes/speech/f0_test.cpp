#include "nodes/speech/f0.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "graph/random.h"
#include "nodes/speech/frame.h"

namespace talkgraph {
namespace {

constexpr double pi = std::numbers::pi;

template <class Signal>
Audio sound(double seconds, double rate, Signal signal) {
  Audio a;
  a.rate = rate;
  a.samples.resize(static_cast<Eigen::Index>(seconds * rate));
  for (Eigen::Index t = 0; t < a.samples.size(); ++t) a.samples[t] = signal(static_cast<double>(t) / rate);
  return a;
}

Track f0(const Audio& audio, const F0& how = {}) { return how(Frame{.window = 0.04}(audio)); }

/// Band-limited pulses, all harmonics below `top` Hz.
double pulses(double phase, double hz, double top) {
  double sum = 0;
  for (int h = 1; h * hz < top; ++h) sum += std::cos(h * phase);
  return 0.5 * sum * hz / top;
}

TEST(F0, IsExactForSinesAndPulseTrains) {
  for (const double rate : {8000.0, 16000.0, 44100.0})
    for (const double hz : {77.0, 100.0, 133.7, 220.0, 391.3, 590.0}) {
      const Track sine = f0(sound(0.3, rate, [&](double t) { return 0.5 * std::sin(2 * pi * hz * t); }));
      const Track train = f0(sound(0.3, rate, [&](double t) { return pulses(2 * pi * hz * t, hz, 3500); }));
      for (const Track& track : {sine, train}) {
        EXPECT_LT((track.values.col(0).array() / hz - 1).abs().maxCoeff(), 2e-3) << hz << " at " << rate;
        EXPECT_GT(track.values.col(1).minCoeff(), 0.95) << hz;
      }
    }
}

TEST(F0, FollowsAGlide) {
  // 100 to 300 Hz in two seconds.
  const Audio audio =
      sound(2, 16000, [](double t) { return pulses(2 * pi * (100 * t + 50 * t * t), 100 + 100 * t, 3500); });
  const Track track = f0(audio);
  for (Eigen::Index t = 0; t < track.frames(); ++t)
    EXPECT_NEAR(track.values(t, 0), 100 + 100 * track.time(t), 0.02 * track.values(t, 0)) << t;
}

TEST(F0, NoiseAndSilenceAreUnvoiced) {
  Random random(5);
  const Track noise = f0(sound(2, 16000, [&](double) { return 0.1 * random.normal(); }));
  EXPECT_LT((noise.values.col(0).array() > 0).cast<double>().mean(), 0.02);
  for (const double constant : {0.0, 0.3, 1.0}) {
    EXPECT_TRUE(f0(sound(0.5, 16000, [&](double) { return constant; })).values.isZero(0)) << constant;
    EXPECT_TRUE(f0(sound(1 / 16000.0, 16000, [&](double) { return constant; })).values.allFinite());
  }
}

TEST(F0, QuietFramesAreUnvoiced) {
  const auto tone = [](double t) { return (t < 0.5 ? 0.5 : 0.001) * std::sin(2 * pi * 150 * t); };
  const Track heard = f0(sound(1, 16000, tone)), all = f0(sound(1, 16000, tone), {.silence_threshold = 0});
  EXPECT_GT(heard.values(20, 0), 0);
  EXPECT_EQ(heard.values(80, 0), 0);
  EXPECT_GT(all.values(80, 0), 0);
}

TEST(F0, VoicingIsThePeriodicShare) {
  // Harmonics to noise 9 to 1 in power.
  Random random(6);
  const double loud = std::sqrt(0.9 * 2), quiet = std::sqrt(0.1);
  const Track track = f0(
      sound(2, 16000, [&](double t) { return 0.1 * (loud * std::sin(2 * pi * 200 * t) + quiet * random.normal()); }));
  EXPECT_NEAR(track.values.col(1).mean(), 0.9, 0.02);
}

TEST(F0, BridgesUnvoicedFramesOnDemand) {
  const auto tones = [](double t) {
    return t < 0.1 || (t > 0.4 && t < 0.6) || t > 0.9 ? 0 : 0.5 * std::sin(2 * pi * (t < 0.5 ? 100 : 200) * t);
  };
  const Track track = f0(sound(1, 16000, tones), {.unvoiced = Unvoiced::bridged});
  EXPECT_GT(track.values.col(0).minCoeff(), 95);
  EXPECT_NEAR(track.values(0, 0), 100, 5);
  EXPECT_NEAR(track.values(48, 0), 141, 12);
  EXPECT_NEAR(track.values(96, 0), 200, 5);
  EXPECT_EQ(track.values(48, 1), 0);
}

TEST(F0, RefusesFramesThatAreTooShort) {
  const Audio audio = sound(1, 16000, [](double t) { return std::sin(700 * t); });
  EXPECT_THROW(F0{}(Frame{}(audio)), std::invalid_argument);
  EXPECT_NO_THROW((F0{.floor = 120}(Frame{}(audio))));
  EXPECT_THROW((F0{.floor = 100, .ceiling = 100}(Frame{.window = 0.04}(audio))), std::invalid_argument);
}

TEST(F0, IsDefinedAtEveryRate) {
  for (const double rate : {8000.0, 11025.0, 22050.0, 48000.0, 96000.0, 192000.0}) {
    const Track track =
        f0(sound(0.2, rate, [](double t) { return std::clamp(9 * std::sin(2 * pi * 180 * t), -1.0, 1.0); }));
    EXPECT_TRUE(track.values.allFinite());
    EXPECT_NEAR(track.values(8, 0), 180, 0.5) << rate;
  }
}

}  // namespace
}  // namespace talkgraph
