#include "nodes/face/prototypes.h"

#include <gtest/gtest.h>

#include <limits>

#include "synthetic_face.h"

namespace talkgraph {
namespace {

struct Corpus {
  Collected<Video> videos;
  Collected<LandmarkTrack> landmarks;
  Collected<FrameLabels> labels;
};

LandmarkTrack marks(int frames) {
  LandmarkTrack l;
  l.scheme = "synthetic";
  for (int t = 0; t < frames; ++t) l.frames.push_back(test::landmarks(test::talking_face(t)));
  return l;
}

Video clip(int frames) {
  std::vector<cv::Mat> all;
  for (int t = 0; t < frames; ++t) all.push_back(test::draw(test::talking_face(t)));
  return video_from_frames(all, Rational(25));
}

Prototypes choose(const Corpus& c, int per_phone, std::uint64_t seed = 1) {
  Random random(seed);
  Context context;
  ChoosePrototypes node;
  node.per_phone = per_phone;
  return node(c.videos, c.landmarks, c.labels, random, context);
}

TEST(ChoosePrototypes, TakesSoManyOfEachPhone) {
  Corpus c;
  for (const auto* key : {"a", "b"}) {
    c.videos.add(key, clip(6));
    c.landmarks.add(key, marks(6));
    c.labels.add(key, FrameLabels{{"sil", "aa", "aa", "aa", "aa", "b"}, Rational(25)});
  }
  EXPECT_EQ(choose(c, 3).images.size(), 2u + 3u + 2u);
  EXPECT_EQ(choose(c, 1).images.size(), 3u);
  EXPECT_EQ(choose(c, 1).scheme, "synthetic");
}

TEST(ChoosePrototypes, CutsTheFaceOutWithItsLandmarks) {
  Corpus c;
  c.videos.add("a", clip(1));
  c.landmarks.add("a", marks(1));
  c.labels.add("a", FrameLabels{{"aa"}, Rational(25)});
  const auto p = choose(c, 4);
  ASSERT_EQ(p.images.size(), 1u);
  const auto whole = test::draw(test::talking_face(0));
  EXPECT_LT(p.images[0].pixels.cols, whole.cols);
  const Eigen::RowVector2d shift = test::landmarks(test::talking_face(0)).row(0) - p.shapes[0].row(0);
  const cv::Rect cut(static_cast<int>(shift.x()), static_cast<int>(shift.y()), p.images[0].pixels.cols,
                     p.images[0].pixels.rows);
  EXPECT_EQ(cv::norm(whole(cut), p.images[0].pixels), 0);
}

TEST(ChoosePrototypes, PassesOverWhatCannotServe) {
  Corpus c;
  auto video = clip(5);
  video.damaged = {0};
  auto l = marks(5);
  l.frames[1](0, 0) = std::numeric_limits<double>::quiet_NaN();
  l.frames[2].array() += 500;
  c.videos.add("a", video);
  c.landmarks.add("a", l);
  c.labels.add("a", FrameLabels{{"x", "x", "x", "x"}, Rational(25)});
  c.videos.add("no landmarks", clip(5));
  c.labels.add("no landmarks", FrameLabels{{"x", "x", "x", "x", "x"}, Rational(25)});
  EXPECT_EQ(choose(c, 9).images.size(), 1u);
}

TEST(ChoosePrototypes, DependsOnTheSeedAlone) {
  Corpus c;
  c.videos.add("a", clip(12));
  c.landmarks.add("a", marks(12));
  c.labels.add("a", FrameLabels{std::vector<std::string>(12, "aa"), Rational(25)});
  EXPECT_EQ(choose(c, 2, 5).shapes[1], choose(c, 2, 5).shapes[1]);
  bool differs = false;
  for (std::uint64_t seed = 6; seed < 12; ++seed) differs |= choose(c, 2, 5).shapes[1] != choose(c, 2, seed).shapes[1];
  EXPECT_TRUE(differs);
}

Prototypes cover(const Corpus& c, int per_phone) {
  Random random(1);
  Context context;
  ChoosePrototypes node;
  node.per_phone = per_phone;
  node.choose = PrototypeChoice::coverage;
  return node(c.videos, c.landmarks, c.labels, random, context);
}

/// Greatest distance of any frame from the nearest prototype, wherever the head is.
double uncovered(const Corpus& c, const Prototypes& p) {
  double worst = 0;
  for (const auto& shape : c.landmarks[0].frames) {
    double nearest = 1e9;
    for (const auto& chosen : p.shapes) {
      const Shape a = shape.rowwise() - shape.row(0), b = chosen.rowwise() - chosen.row(0);
      nearest = std::min(nearest, (a - b).norm());
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(ChoosePrototypes, CoverTheSpaceOfShapes) {
  Corpus c;
  std::vector<cv::Mat> pictures;
  LandmarkTrack l;
  for (int t = 0; t < 60; ++t) {
    test::SyntheticFace f;
    f.open = t % 20 == 19 ? 0.1 * (t / 20 + 7) : 0.2 + 0.01 * t / 60;
    pictures.push_back(test::draw(f));
    l.frames.push_back(test::landmarks(f));
  }
  c.videos.add("a", video_from_frames(pictures, Rational(25)));
  c.landmarks.add("a", l);
  c.labels.add("a", FrameLabels{std::vector<std::string>(60, "aa"), Rational(25)});
  const auto p = cover(c, 4);
  EXPECT_EQ(p.shapes.size(), 4u);
  EXPECT_LT(uncovered(c, p), 0.5) << "the three mouths that are open, and one that is not";
  EXPECT_GT(uncovered(c, choose(c, 4)), 5) << "chance misses them";
}

TEST(ChoosePrototypes, CoverWithAsManyAsAtRandom) {
  Corpus c;
  c.videos.add("a", clip(6));
  c.landmarks.add("a", marks(6));
  c.labels.add("a", FrameLabels{{"sil", "aa", "aa", "aa", "aa", "b"}, Rational(25)});
  EXPECT_EQ(cover(c, 3).images.size(), choose(c, 3).images.size());
  EXPECT_EQ(cover(c, 9).images.size(), 6u);
  c.videos.add("b", clip(1));
  LandmarkTrack fewer = marks(1);
  fewer.frames[0].conservativeResize(5, 2);
  c.landmarks.add("b", fewer);
  c.labels.add("b", FrameLabels{{"aa"}, Rational(25)});
  EXPECT_THROW(cover(c, 3), std::runtime_error);
  EXPECT_THROW(cover({}, 3), std::runtime_error);
}

TEST(ChoosePrototypes, SaysSoWhenNothingCanServe) {
  try {
    choose({}, 4);
    ADD_FAILURE() << "nothing was refused";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("talkgraph annotate"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace talkgraph
