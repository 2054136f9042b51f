#include "nodes/write/clip.h"

#include "nodes/media/audio_file.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/media/video_file.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class EncodeTest : public MediaTest {
 protected:
  void SetUp() override {
    if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
    context_.folder = folder_;
    context_.item = "clip";
  }
  std::string encode(const Video& video, const Audio* audio, ClipFormat format = ClipFormat::mp4) {
    WriteClip node;
    node.format = format;
    return (folder_ / node(video, audio, context_).path).string();
  }
  Context context_;
};

struct Shape {
  ClipFormat format;
  Rational rate;
};
class EncodeShapes : public EncodeTest, public testing::WithParamInterface<Shape> {};

TEST_P(EncodeShapes, FramesAndSoundSurvive) {
  const auto [format, rate] = GetParam();
  const Video video = test_video(50, rate);
  const Audio sound = tone(1.2, 16000);
  const std::string file = encode(video, &sound, format);
  const Video back = open_video(file);
  EXPECT_EQ(back.source->rate(), rate);
  EXPECT_EQ(back.source->frames(), 50);
  EXPECT_EQ(back.source->size(), cv::Size(96, 64));
  EXPECT_TRUE(back.source->decoding_errors().empty());
  const auto pictures = back.read_all();
  ASSERT_EQ(pictures.size(), 50u);
  for (int n = 0; n < 50; ++n) {
    EXPECT_LT(mean_difference(pictures[n], test_picture(n)), 3) << n;
    if (n > 0) {
      EXPECT_LT(mean_difference(pictures[n], test_picture(n)), mean_difference(pictures[n], test_picture(n - 1)));
    }
  }

  const double seconds = 50 / rate.value();
  const Audio heard = read_audio(file);
  EXPECT_NEAR(heard.seconds(), seconds, 2 / heard.rate);
  const Eigen::Index known = static_cast<Eigen::Index>(1.1 * heard.rate);
  const Eigen::VectorXd expected = tone(1.1, heard.rate).samples;
  const double correlation =
      heard.samples.head(known).dot(expected) / heard.samples.head(known).norm() / expected.norm();
  EXPECT_GT(correlation, 0.99) << "the sound must neither be shifted nor distorted";
  EXPECT_LT(heard.samples.tail(heard.samples.size() / 4).cwiseAbs().maxCoeff(), 0.01) << "padded with silence";
}

INSTANTIATE_TEST_SUITE_P(Formats, EncodeShapes,
                         testing::Values(Shape{ClipFormat::mp4, {25}}, Shape{ClipFormat::mp4, {30000, 1001}},
                                         Shape{ClipFormat::webm, {25}}, Shape{ClipFormat::webm, {30000, 1001}}));

TEST_F(EncodeTest, LongSoundIsCutToThePicture) {
  const Audio sound = tone(3, 44100);
  EXPECT_NEAR(read_audio(encode(test_video(25, 25), &sound)).seconds(), 1, 1e-4);
}

TEST_F(EncodeTest, EmptySoundBecomesSilence) {
  const Audio none{{}, 16000};
  const Audio heard = read_audio(encode(test_video(25, 25), &none));
  EXPECT_NEAR(heard.seconds(), 1, 1e-4);
  EXPECT_EQ(heard.samples.cwiseAbs().maxCoeff(), 0);
}

TEST_F(EncodeTest, RatesThatTheFormatLacksAreResampled) {
  const Audio sound = tone(1, 44100);
  EXPECT_EQ(read_audio(encode(test_video(25, 25), &sound, ClipFormat::webm)).rate, 48000);
  const Audio odd = tone(1, 20000);
  EXPECT_EQ(read_audio(encode(test_video(25, 25), &odd)).rate, 48000);
}

TEST_F(EncodeTest, WithoutSound) {
  const std::string file = encode(test_video(3, 25), nullptr);
  EXPECT_EQ(open_video(file).source->frames(), 3);
  EXPECT_THAT(error_of([&] { read_audio(file); }), HasSubstr("holds no sound"));
}

TEST_F(EncodeTest, OneFrame) {
  const Audio sound = tone(1, 16000);
  const std::string file = encode(test_video(1, 25), &sound);
  EXPECT_EQ(open_video(file).source->frames(), 1);
  EXPECT_NEAR(read_audio(file).seconds(), 0.04, 1e-4);
}

TEST_F(EncodeTest, OddSidesAreExtended) {
  const std::string file = encode(test_video(5, 25, {95, 63}), nullptr);
  const Video back = open_video(file);
  EXPECT_EQ(back.source->size(), cv::Size(96, 64));
  EXPECT_LT(mean_difference(back.read_all()[4]({0, 0, 95, 63}), test_picture(4, {95, 63})), 3);
}

TEST_F(EncodeTest, ColoursGoRoundInBothColourSpaces) {
  for (const cv::Size size : {cv::Size(64, 64), cv::Size(64, 720)})
    for (const cv::Scalar& colour : {cv::Scalar(30, 30, 200), cv::Scalar(200, 40, 30), cv::Scalar(40, 180, 60)}) {
      const cv::Mat flat(size, CV_8UC3, colour);
      const auto back = open_video(encode(video_from_frames({flat}, 25), nullptr)).read_all();
      EXPECT_LT(cv::norm(back[0], flat, cv::NORM_INF), 5) << size << colour;
    }
}

TEST_F(EncodeTest, TheSameInputGivesTheSameBytes) {
  const Audio sound = tone(1, 16000);
  for (const auto format : {ClipFormat::mp4, ClipFormat::webm}) {
    const std::string once = bytes(encode(test_video(10, 25), &sound, format));
    EXPECT_FALSE(once.empty());
    EXPECT_EQ(once, bytes(encode(test_video(10, 25), &sound, format)));
  }
}

TEST_F(EncodeTest, NamesAndFolders) {
  WriteClip node;
  node.prefix = "a-";
  node.suffix = "-b";
  context_.item = "s1/x";
  EXPECT_EQ(node(test_video(2, 25), nullptr, context_).path, "clips/a-s1/x-b.mp4");
  context_.item = "";
  EXPECT_EQ(WriteClip{}(test_video(2, 25), nullptr, context_).path, "clips/clip.mp4");
}

TEST_F(EncodeTest, NothingIsLeftOfAClipThatFails) {
  const Video changing = video_from_frames({test_picture(0), test_picture(1, {32, 32})}, 25);
  EXPECT_THAT(error_of([&] { encode(changing, nullptr); }), HasSubstr("frame 1 differs in size"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "clips"));
}

TEST_F(EncodeTest, BadInput) {
  EXPECT_THAT(error_of([&] { encode(video_from_frames({}, 25), nullptr); }), HasSubstr("without one frame"));
  write("file", "x");
  context_.folder = folder_ / "file";
  EXPECT_THAT(error_of([&] { encode(test_video(2, 25), nullptr); }), HasSubstr("cannot be made"));
}

TEST_F(EncodeTest, CancellingStopsIt) {
  std::atomic<bool> cancel = true;
  context_.cancel = &cancel;
  EXPECT_THROW(encode(test_video(2, 25), nullptr), Cancelled);
}

}  // namespace
}  // namespace talkgraph
