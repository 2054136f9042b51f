#include "nodes/media/video_file.h"

#include <opencv2/imgcodecs.hpp>

#include "nodes/media/audio_file.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/media/video.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

class VideoFileTest : public MediaTest {
 protected:
  std::string clip(int frames, ClipFormat format) {
    const std::string file = path(format == ClipFormat::mp4 ? "clip.mp4" : "clip.webm");
    ffmpeg_encode(file, test_video(frames, 25), nullptr, {format, 18}, Context());
    return file;
  }
};

TEST_F(VideoFileTest, ErrorsNameTheFile) {
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  EXPECT_THAT(error_of([&] { open_video(path("no.mp4")); }), HasSubstr("no.mp4: there is no such file"));
  EXPECT_THAT(error_of([&] { open_video(folder_.string()); }), HasSubstr("is not a file"));
  EXPECT_THAT(error_of([&] { open_video(write("text.mp4", std::string(5000, 'x'))); }), HasSubstr("text.mp4: "));
  EXPECT_THAT(error_of([&] { open_video(write("text.txt", "hello\n")); }), HasSubstr("text.txt: "));
  EXPECT_THAT(error_of([&] { open_video(write("empty.mp4", "")); }), HasSubstr("empty.mp4: "));
  write_audio(path("sound.wav"), tone(1, 16000));
  EXPECT_THAT(error_of([&] { open_video(path("sound.wav")); }), HasSubstr("holds no video"));
}

TEST_F(VideoFileTest, TruncatedFilesAreFoundOut) {
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  const std::string whole = bytes(clip(100, ClipFormat::mp4));
  for (const double share : {0.1, 0.5, 0.9}) {
    const std::string part = write("part.mp4", whole.substr(0, static_cast<std::size_t>(share * whole.size())));
    EXPECT_THAT(error_of([&] { open_video(part).source->frames(); }),
                AnyOf(HasSubstr("breaks off"), HasSubstr("cannot be read")))
        << share;
  }
}

TEST_F(VideoFileTest, ReadersAreIndependent) {
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  const Video video = open_video(clip(10, ClipFormat::mp4));
  const auto a = video.source->open(), b = video.source->open();
  cv::Mat first, second, other;
  ASSERT_TRUE(a->next(first));
  ASSERT_TRUE(a->next(second));
  ASSERT_TRUE(b->next(other));
  EXPECT_EQ(cv::norm(first, other, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(first, second, cv::NORM_INF), 0) << "frames do not share their pixels";
}

TEST_F(VideoFileTest, ContentKeyFollowsTheBytes) {
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  const std::string file = clip(5, ClipFormat::mp4);
  const Key key = open_video(file).source->key();
  std::filesystem::copy(file, path("copy.mp4"));
  EXPECT_EQ(open_video(path("copy.mp4")).source->key(), key);
  EXPECT_NE(open_video(clip(6, ClipFormat::mp4)).source->key(), key);
}

TEST_F(VideoFileTest, FolderOfPictures) {
  for (const int n : {1, 2, 9, 10, 11}) cv::imwrite(path("frame" + std::to_string(n) + ".png"), test_picture(n));
  write("notes.txt", "not a picture");
  const Video video = open_frame_folder(folder_.string(), {30000, 1001});
  EXPECT_EQ(video.source->frames(), 5);
  EXPECT_EQ(video.source->rate(), Rational(30000, 1001));
  EXPECT_EQ(video.source->size(), cv::Size(96, 64));
  const auto pictures = video.read_all();
  ASSERT_EQ(pictures.size(), 5u);
  EXPECT_EQ(cv::norm(pictures[2], test_picture(9), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(pictures[3], test_picture(10), cv::NORM_INF), 0);
  const Key key = video.source->key();
  cv::imwrite(path("frame9.png"), test_picture(8));
  EXPECT_NE(video.source->key(), key);
}

TEST_F(VideoFileTest, FolderErrors) {
  EXPECT_THAT(error_of([&] { open_frame_folder(path("none"), 25); }), HasSubstr("there is no such folder"));
  EXPECT_THAT(error_of([&] { open_frame_folder(folder_.string(), 25); }), HasSubstr("there is no PNG or JPEG"));
  cv::imwrite(path("1.png"), test_picture(1));
  cv::imwrite(path("2.png"), test_picture(1, {32, 32}));
  EXPECT_THAT(error_of([&] { open_frame_folder(folder_.string(), 25).read_all(); }),
              HasSubstr("2.png: differs in size"));
  write("2.png", "broken");
  EXPECT_THAT(error_of([&] { open_frame_folder(folder_.string(), 25).read_all(); }),
              HasSubstr("2.png: cannot be decoded"));
}

TEST(NaturalOrder, NumbersGoByValue) {
  EXPECT_TRUE(natural_less("f2", "f10"));
  EXPECT_FALSE(natural_less("f10", "f2"));
  EXPECT_TRUE(natural_less("f2a3", "f2a20"));
  EXPECT_TRUE(natural_less("a", "ab"));
  EXPECT_TRUE(natural_less("f01", "f1") != natural_less("f1", "f01"));
  EXPECT_FALSE(natural_less("f1", "f1"));
}

TEST_F(VideoFileTest, TheNodeTakesFilesFoldersAndStills) {
  cv::imwrite(path("1.png"), test_picture(1));
  cv::imwrite(path("2.png"), test_picture(2));
  OpenVideo node;
  node.file = {folder_.string()};
  node.rate = 10;
  EXPECT_EQ(node().source->frames(), 2);
  EXPECT_EQ(node().source->rate(), Rational(10));
  node.file = {path("2.png")};
  EXPECT_EQ(node().source->frames(), 1);
  node.file = {path("3.png")};
  EXPECT_THAT(error_of([&] { node(); }), HasSubstr("3.png: there is no such file"));
}

}  // namespace
}  // namespace talkgraph
