#include "nodes/face/redraw.h"

#include <gtest/gtest.h>

#include "nodes/face/build.h"
#include "nodes/face/track.h"
#include "synthetic_face.h"

namespace talkgraph {
namespace {

AppearanceModel build() {
  Context context;
  return BuildAppearance{}(test::synthetic_prototypes(), context);
}

TEST(RedrawFace, ShowsWhatWasFound) {
  std::vector<cv::Mat> frames;
  for (int t = 0; t < 4; ++t) {
    auto face = test::talking_face(t);
    face.gain = 0.8;
    face.offset = 20;
    frames.push_back(test::draw(face));
  }
  auto video = video_from_frames(frames, Rational(25));
  video.damaged = {3};
  const auto model = build();
  Context context;
  auto track = TrackFace{}(model, video, context);
  const auto redrawn = RedrawFace{}(model, track, video);
  EXPECT_EQ(redrawn.damaged, video.damaged);
  const auto drawn = redrawn.read_all();
  ASSERT_EQ(drawn.size(), 4u);
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_GT(test::psnr(drawn[t], frames[t]), 36) << t;
    EXPECT_NE(cv::norm(drawn[t], frames[t], cv::NORM_INF), 0) << t;
    EXPECT_EQ(drawn[t].at<cv::Vec3b>(2, 2), frames[t].at<cv::Vec3b>(2, 2));
  }
  const Key before = redrawn.source->key();
  track.offset[0] += 1;
  EXPECT_NE(RedrawFace{}(model, track, video).source->key(), before);
}

TEST(RedrawFace, KeepsTheFacesColourUpToItsEdge) {
  auto model = build();
  const auto values = model.levels[0].mean->rows();
  Eigen::MatrixXf plain(values, 1);
  for (Eigen::Index i = 0; i < values; ++i) plain(i, 0) = static_cast<float>(i % 3 - 1) / model.texture_gain;
  model.levels[0].mean = std::make_shared<Eigen::MatrixXf>(plain);
  const auto video = video_from_frames({cv::Mat(200, 200, CV_8UC3, cv::Scalar(1, 2, 3))}, Rational(25));
  Context context;
  auto track = TrackFace{}(model, video, context);
  track.parameters.values.setZero();
  track.shapes[0] = test::landmarks({});
  track.gain[0] = 60 * model.texture_gain;
  track.offset[0] = 100;
  const cv::Mat drawn = RedrawFace{}(model, track, video).read_all()[0];
  int face = 0;
  for (const auto& pixel : cv::Mat_<cv::Vec3b>(drawn)) {
    if (pixel == cv::Vec3b(1, 2, 3)) continue;
    EXPECT_EQ(pixel, cv::Vec3b(40, 100, 160));
    ++face;
  }
  EXPECT_GT(face, 5000);
}

TEST(RedrawFace, RefusesTheTrackOfAnother) {
  const auto model = build();
  const auto video = video_from_frames({test::draw({})}, Rational(25));
  Context context;
  auto track = TrackFace{}(model, video, context);
  EXPECT_THROW(RedrawFace{}(model, track, video_from_frames({}, Rational(25))), std::runtime_error);
  track.parameters.values.conservativeResize(1, 1);
  EXPECT_THROW(RedrawFace{}(model, track, video), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
