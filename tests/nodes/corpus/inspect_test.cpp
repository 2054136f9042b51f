#include "nodes/corpus/inspect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "graph/random.h"

namespace talkgraph {
namespace {

constexpr int frames = 75;

/// How loud it is, and how open the mouth, at a frame: irregular bursts.
double loudness(int t) {
  Random random(17);
  std::vector<double> all(frames + 20);
  for (double& v : all) v = random.uniform();
  const auto at = static_cast<std::size_t>(std::clamp(t + 10, 1, frames + 18));
  return std::max(0.0, all[at] + 0.5 * (all[at - 1] + all[at + 1]) - 0.6);
}

Audio sound() {
  Random random(3);
  Audio audio{Eigen::VectorXd(3 * 8000), 8000};
  for (Eigen::Index n = 0; n < audio.samples.size(); ++n)
    audio.samples(n) = (0.001 + 0.3 * loudness(static_cast<int>(n / 320))) * (2 * random.uniform() - 1);
  return audio;
}

/// How open the mouth is: it moves most while it is loud.
double opening(int t) { return loudness(t) * (t % 2 == 0 ? 1 : 0.4); }

/// A dark mouth that moves with the sound, `late` frames behind it.
Video pictures(int late) {
  std::vector<cv::Mat> all;
  for (int t = 0; t < frames; ++t) {
    cv::Mat frame(80, 60, CV_8UC3, cv::Scalar::all(180));
    const int open = static_cast<int>(14 * opening(t - late));
    frame(cv::Rect(20, 50, 20, open + 1)).setTo(cv::Scalar::all(40));
    all.push_back(frame);
  }
  return video_from_frames(all, Rational(25), "pictures");
}

LandmarkTrack lips(int late) {
  LandmarkTrack track;
  track.scheme = "ibug68";
  for (int t = 0; t < frames; ++t) {
    Shape shape = Shape::Constant(68, 2, 10);
    shape.row(0) << 5, 20;
    shape.row(1) << 55, 78;
    shape.row(62) << 30, 50;
    shape.row(66) << 30, 50 + 14 * opening(t - late);
    track.frames.push_back(shape);
  }
  return track;
}

Recording recording(int late) {
  Recording r;
  r.id = "a";
  r.audio = [] { return sound(); };
  r.video = [late] { return pictures(late); };
  return r;
}

Inspect::Out inspect(const Recording& r) {
  Context context;
  return Inspect{}(r, context);
}

int best_lag(const Scores& found) {
  int best = 0;
  double most = -2;
  for (int lag = -8; lag <= 8; ++lag) {
    const double r = found.values.at("lag " + std::to_string(lag));
    if (r > most) most = r, best = lag;
  }
  return best;
}

TEST(Inspect, TellsRatesAndLengths) {
  const auto found = inspect(recording(0)).findings.values;
  EXPECT_EQ(found.at("sound_rate"), 8000);
  EXPECT_EQ(found.at("sound_seconds"), 3);
  EXPECT_EQ(found.at("fps"), 25);
  EXPECT_EQ(found.at("frames"), frames);
  EXPECT_EQ(found.at("width"), 60);
  EXPECT_EQ(found.at("picture_seconds"), 3);
  EXPECT_EQ(found.at("damaged"), 0);
  EXPECT_LT(found.at("red"), 180);
  EXPECT_EQ(found.at("red"), found.at("blue"));
  for (const char* part : {"transcript", "words", "phones", "landmarks", "visual"}) EXPECT_EQ(found.at(part), 0);
  EXPECT_FALSE(found.contains("landmark_frames"));
}

TEST(Inspect, FindsTheShiftOfThePicture) {
  for (const int late : {-5, 0, 3, 7}) {
    auto r = recording(late);
    EXPECT_NEAR(best_lag(inspect(r).findings), late, 1) << "by what moves in the picture";
    r.landmarks = lips(late);
    EXPECT_NEAR(best_lag(inspect(r).findings), late, 1) << "by the lips";
    r.landmarks->scheme = "";
    EXPECT_NEAR(best_lag(inspect(r).findings), late, 1) << "by what moves in the lower half of the landmarks";
  }
}

TEST(Inspect, CountsWhatIsBroken) {
  auto r = recording(0);
  r.video = [] {
    auto all = pictures(0).read_all();
    all[10].setTo(cv::Scalar(0, 255, 0));
    all[12].setTo(cv::Scalar(0, 255, 0));
    return video_from_frames(all, Rational(25), "broken");
  };
  r.landmarks = lips(0);
  r.landmarks->frames.pop_back();
  r.landmarks->frames[4](3, 0) = NAN;
  const auto found = inspect(r).findings.values;
  EXPECT_EQ(found.at("damaged"), 2);
  EXPECT_EQ(found.at("damaged_from"), 10);
  EXPECT_EQ(found.at("damaged_to"), 12);
  EXPECT_EQ(found.at("landmark_frames"), frames - 1);
  EXPECT_EQ(found.at("landmark_gaps"), 1);
}

TEST(Inspect, CountsPhonesAsGivenElseAsPronounced) {
  auto r = recording(0);
  EXPECT_TRUE(inspect(r).phones.values.empty());
  r.transcript = Transcript{"Bob, bob 2"};
  EXPECT_THAT(inspect(r).phones.values, testing::ElementsAre(testing::Pair("aa", 2), testing::Pair("b", 4),
                                                             testing::Pair("t", 1), testing::Pair("uw", 1)));
  r.phones = PhoneTrack{{{"sil", 0, 1}, {"oh", 1, 2}, {"b", 2, 3}}};
  EXPECT_THAT(inspect(r).phones.values, testing::ElementsAre(testing::Pair("b", 1), testing::Pair("oh", 1)));
}

TEST(Inspect, SilenceAndStillPicturesHaveNoLag) {
  auto r = recording(0);
  r.audio = [] { return Audio{Eigen::VectorXd::Zero(24000), 8000}; };
  const auto found = inspect(r).findings.values;
  EXPECT_EQ(found.at("sound_peak"), 0);
  EXPECT_FALSE(found.contains("lag 0"));
  r = recording(0);
  r.video = [] {
    return video_from_frames(std::vector<cv::Mat>(5, cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(9))), Rational(25));
  };
  EXPECT_FALSE(inspect(r).findings.values.contains("lag 0"));
  r.video = nullptr;
  r.audio = [] { return Audio{Eigen::VectorXd(0), 8000}; };
  EXPECT_EQ(inspect(r).findings.values.at("sound_seconds"), 0);
}

}  // namespace
}  // namespace talkgraph
