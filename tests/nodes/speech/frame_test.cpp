#include "nodes/speech/frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace talkgraph {
namespace {

/// Sample i is i, so a frame's first value says where it begins.
Audio ramp(int samples, double rate = 16000) {
  Audio a;
  a.rate = rate;
  a.samples = Eigen::VectorXd::LinSpaced(samples, 0, samples - 1);
  return a;
}

TEST(Frame, CountsWholeFrames) {
  EXPECT_EQ(Frame{}(ramp(1)).values.rows(), 1);
  EXPECT_EQ(Frame{}(ramp(400)).values.rows(), 1);
  EXPECT_EQ(Frame{}(ramp(559)).values.rows(), 1);
  EXPECT_EQ(Frame{}(ramp(560)).values.rows(), 2);
  // Windows shorter than the hop.
  EXPECT_EQ((Frame{.window = 0.001, .rate = 50}(ramp(976)).values.rows()), 4);
  EXPECT_EQ((Frame{.window = 0.001, .rate = 50}(ramp(975)).values.rows()), 3);
}

TEST(Frame, FractionalHopsDoNotDriftOverAnHour) {
  // 22.05 kHz has 220.5 samples in 10 ms.
  const Frames frames = Frame{.window = 0.001}(ramp(22050 * 3600, 22050));
  for (const Eigen::Index t : {0, 1, 2, 5001, 359999}) {
    EXPECT_EQ(frames.values(t, 0), std::floor(static_cast<double>(t) * 220.5 + 0.5)) << t;
  }
}

TEST(Frame, BeginsAtTheNearestSampleAtNtscRate) {
  const std::int64_t rate = 44100, num = 30000, den = 1001;
  const Frames frames = Frame{.window = 0.002, .rate = Rational(num, den)}(ramp(44100 * 60, 44100));
  for (Eigen::Index t = 0; t < frames.values.rows(); ++t)  // round half up in whole numbers
    ASSERT_EQ(frames.values(t, 0), static_cast<double>((2 * t * rate * den + num) / (2 * num))) << t;
}

TEST(Frame, CentredFramesLieOnTheVideoGrid) {
  for (const Rational fps : {Rational(25), Rational(30000, 1001), Rational(50)}) {
    const Audio audio = ramp(16000 * 3);
    const Frames frames = Frame{.window = 0.05, .rate = fps, .centred = true}(audio);
    EXPECT_EQ(frames.values.rows(), std::lround(3 * fps.value()));
    EXPECT_DOUBLE_EQ(frames.start, 0.5 / fps.value());
    for (Eigen::Index t = 2; t < frames.values.rows() - 2; ++t) {
      const double centre = frames.values(t, 400) / 16000;  // of 800 samples
      EXPECT_NEAR(centre, (static_cast<double>(t) + 0.5) / fps.value(), 0.51 / 16000);
    }
  }
}

TEST(Frame, CentredFramesArePaddedWithZeros) {
  Audio audio;
  audio.samples = Eigen::VectorXd::Ones(640);  // 40 ms
  const Frames frames = Frame{.window = 0.05, .rate = 25, .centred = true}(audio);
  ASSERT_EQ(frames.values.rows(), 1);
  Eigen::RowVectorXd expected = Eigen::RowVectorXd::Zero(800);
  expected.segment(80, 640).setOnes();
  EXPECT_EQ(Eigen::RowVectorXd(frames.values.row(0)), expected);
}

TEST(Frame, FillsUpTheLastFrameOnDemand) {
  const auto rows = [](FrameEnds ends, int samples) { return Frame{.ends = ends}(ramp(samples)).values; };
  for (const auto ends : {FrameEnds::zeros, FrameEnds::mirror}) {
    EXPECT_EQ(rows(ends, 1).rows(), 1);
    EXPECT_EQ(rows(ends, 400).rows(), 1);
    EXPECT_EQ(rows(ends, 401).rows(), 2);
    EXPECT_EQ(rows(ends, 560).rows(), 2);
    EXPECT_EQ(rows(ends, 561).rows(), 3);
  }
  const FrameMatrix zeros = rows(FrameEnds::zeros, 410), mirror = rows(FrameEnds::mirror, 410);
  EXPECT_EQ(zeros(1, 249), 409);
  EXPECT_EQ(zeros(1, 250), 0);
  EXPECT_EQ(mirror(1, 249), 409);
  EXPECT_EQ(mirror(1, 250), 409);
  EXPECT_EQ(mirror(1, 251), 408);
  EXPECT_TRUE(rows(FrameEnds::mirror, 0).isZero(0));
}

// Kaldi's --snip-edges=false: frame t begins at 160 (t + ½) - 200, what lies outside is mirrored.
TEST(Frame, MirrorsBothEndsOfCentredFrames) {
  const FrameMatrix frames = Frame{.centred = true, .ends = FrameEnds::mirror}(ramp(480)).values;
  ASSERT_EQ(frames.rows(), 3);
  for (int t = 0; t < 3; ++t)
    for (int i = 0; i < 400; ++i) {
      int at = 160 * t - 120 + i;
      if (at < 0) at = -at - 1;
      if (at >= 480) at = 2 * 480 - 1 - at;
      ASSERT_EQ(frames(t, i), at) << t << " " << i;
    }
  const FrameMatrix short_sound = Frame{.centred = true, .ends = FrameEnds::mirror}(ramp(3)).values;
  EXPECT_EQ(short_sound.maxCoeff(), 2);  // mirrored again and again
}

TEST(Frame, PadsShortSoundWithZeros) {
  for (const bool centred : {false, true}) {
    const Frame frame{.centred = centred};
    EXPECT_EQ(frame(ramp(0)).values, FrameMatrix::Zero(1, 400));
    EXPECT_EQ(frame(ramp(2)).values.sum(), 1);
  }
}

TEST(Frame, RefusesHopsShorterThanASample) {
  EXPECT_THROW((Frame{.window = 0.025, .rate = 20000}(ramp(1000))), std::invalid_argument);
  EXPECT_THROW((Frame{.window = 1e-6}(ramp(1000))), std::invalid_argument);
}

TEST(Frame, RefusesBrokenSound) {
  Audio audio = ramp(1000);
  audio.samples[500] = NAN;
  EXPECT_THROW(Frame{}(audio), std::runtime_error);
  audio.samples[500] = INFINITY;
  EXPECT_THROW(Frame{}(audio), std::runtime_error);
  audio.samples[500] = -1e101;
  EXPECT_THROW(Frame{}(audio), std::runtime_error);
  audio.samples[500] = -1e100;
  EXPECT_NO_THROW(Frame{}(audio));
  EXPECT_THROW(Frame{}(ramp(1000, 0)), std::runtime_error);
  EXPECT_THROW(Frame{}(ramp(1000, NAN)), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
