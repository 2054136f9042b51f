#include "nodes/media/check_video.h"

#include <numeric>

#include "nodes/media/ffmpeg.h"
#include "nodes/media/video_file.h"
#include "tests/nodes/media/media_test.h"
#include "tests/source_folder.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Video checked(std::vector<cv::Mat> frames) {
  Context context;
  return CheckVideo{}(video_from_frames(std::move(frames), 25), context);
}

std::vector<cv::Mat> sound_frames(int count) { return test_video(count, 25).read_all(); }

TEST(CheckVideo, SoundFramesPass) { EXPECT_THAT(checked(sound_frames(40)).damaged, IsEmpty()); }

TEST(CheckVideo, GreyBlackAndForeignFramesAreMarked) {
  auto frames = sound_frames(40);
  frames[0].setTo(cv::Scalar::all(0));
  frames[7].setTo(cv::Scalar(255, 255, 255));
  frames[39].setTo(cv::Scalar(0, 0, 255));
  EXPECT_THAT(checked(frames).damaged, ElementsAre(0, 7, 39));
}

TEST(CheckVideo, MarksAreKeptAndLogged) {
  auto frames = sound_frames(10);
  frames[3].setTo(cv::Scalar::all(0));
  Video video = video_from_frames(frames, 25, "clip");
  video.damaged = {8, 1};
  std::string log;
  Context context;
  context.on_warning = [&](std::string_view text) { log += text; };
  EXPECT_THAT(CheckVideo{}(video, context).damaged, ElementsAre(1, 3, 8));
  EXPECT_THAT(log, HasSubstr("clip: 3 of 10 frames are damaged"));
}

TEST(CheckVideo, ShortClips) {
  EXPECT_THAT(checked({}).damaged, IsEmpty());
  EXPECT_THAT(checked(sound_frames(1)).damaged, IsEmpty());
  EXPECT_THAT(checked({test_picture(0), cv::Mat(64, 96, CV_8UC3, cv::Scalar::all(0))}).damaged, IsEmpty());
  EXPECT_THAT(checked({cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9)), cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9)),
                       cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9))})
                  .damaged,
              IsEmpty());
}

TEST(CheckVideo, BrokenClipsOfGrid) {
  const std::string folder = test::source("/../shared/data/grid-s1/video/");
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << ", recordings of GRID, is not there";
  Context context;
  std::vector<std::int64_t> first_twelve(12);
  std::iota(first_twelve.begin(), first_twelve.end(), 0);
  EXPECT_EQ(CheckVideo{}(open_video(folder + "sbbh4p.mpg"), context).damaged, first_twelve);
  EXPECT_EQ(CheckVideo{}(open_video(folder + "sran9s.mpg"), context).damaged, first_twelve);
  EXPECT_THAT(CheckVideo{}(open_video(folder + "bbaf2n.mpg"), context).damaged, IsEmpty());
}

}  // namespace
}  // namespace talkgraph
