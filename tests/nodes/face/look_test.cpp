#include "nodes/face/look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "nodes/face/base_clip.h"
#include "nodes/face/build.h"
#include "nodes/face/composite.h"
#include "nodes/face/eyes.h"
#include "nodes/face/geometry.h"
#include "nodes/face/mouths.h"
#include "nodes/face/render.h"
#include "nodes/face/select_mouths.h"
#include "nodes/face/track.h"
#include "nodes/types/scheme.h"
#include "synthetic_face.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

const std::vector<int> left_and_right_eye = {16, 17, 18, 19, 20, 21, 22, 23}, nose = {24, 25, 26, 27},
                       upper_lids = {19, 23}, lower_lids = {17, 21}, mouth = {28, 29, 30, 31, 32, 33, 34, 35};

/// A face whose lids move too: the point on the upper lid comes down by as much as is named, pixels.
Prototypes blinking_prototypes() {
  auto p = test::synthetic_prototypes();
  for (std::size_t i = 0; i < p.shapes.size(); ++i)
    for (const int lid : upper_lids) p.shapes[i](lid, 1) += static_cast<double>(i % 3);
  return p;
}

AppearanceModel build(const Prototypes& prototypes) {
  Context context;
  return BuildAppearance{}(prototypes, context);
}
const AppearanceModel& model() {
  static const AppearanceModel built = build(test::synthetic_prototypes());
  return built;
}
const AppearanceModel& blinking_model() {
  static const AppearanceModel built = build(blinking_prototypes());
  return built;
}

/// Parameters drawn from the model's own distribution.
Track random_track(const AppearanceModel& m, Eigen::Index frames, std::uint64_t seed, Rational rate = Rational(25)) {
  Random random(seed);
  Track t{Eigen::MatrixXd(frames, m.modes()), rate, 0.5 / rate.value(), {}};
  for (auto& v : t.values.reshaped()) v = random.normal();
  t.values *= m.combined_variances.cwiseSqrt().asDiagonal();
  return t;
}

MakeEyes eyes_from(EyeSource source) {
  MakeEyes node;
  node.source = source;
  node.points = left_and_right_eye;
  node.nose = nose;
  node.upper_lids = upper_lids;
  node.lower_lids = lower_lids;
  return node;
}

Eyes make(const MakeEyes& node, const AppearanceModel& m, const Track& track, const Track* given = nullptr,
          std::uint64_t seed = 1) {
  Random random(seed);
  return node(m, track, given, random);
}

std::string complaint(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "nothing";
}

double gap(const AppearanceModel& m, const Eigen::VectorXd& c) {
  const Shape s = m.shape(c);
  return 0.5 * (s(17, 1) - s(19, 1) + s(21, 1) - s(23, 1));
}

TEST(Eyes, StillOnesAreThoseOfTheMean) {
  const auto eyes = make(eyes_from(EyeSource::still), model(), random_track(model(), 3, 1));
  EXPECT_EQ(eyes.parameters.values, Eigen::MatrixXd::Zero(3, model().modes()));
  EXPECT_EQ(eyes.points, left_and_right_eye);
}

TEST(Eyes, StayTheBasesIfNothingElseIsSaid) {
  const Track track = random_track(model(), 1, 1);
  const auto eyes = make(MakeEyes{}, model(), track);
  EXPECT_TRUE(eyes.points.empty());
  EXPECT_EQ(Looks(model(), track, &eyes, nullptr).at(0).texture, Looks(model(), track, nullptr, nullptr).at(0).texture);
}

TEST(Eyes, BlinkOnASeededSchedule) {
  const auto& m = blinking_model();
  const Track track = random_track(m, 100 * 60, 1, Rational(100));
  auto node = eyes_from(EyeSource::blinking);
  node.reach = 100;
  const auto eyes = make(node, m, track);
  EXPECT_EQ(eyes.parameters.values, make(node, m, track).parameters.values);
  EXPECT_NE(eyes.parameters.values, make(node, m, track, nullptr, 2).parameters.values);
  const double open = gap(m, Eigen::VectorXd::Zero(m.modes()));
  std::vector<double> begins;
  double least = open;
  bool shutting = false;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const double now = gap(m, eyes.parameters.values.row(t));
    EXPECT_LE(now, open + 1e-9);
    least = std::min(least, now);
    const bool moves = now < open - 1e-9;
    if (moves && !shutting) begins.push_back(track.time(t));
    shutting = moves;
  }
  EXPECT_NEAR(least, 0, 0.01 * open);
  ASSERT_GT(begins.size(), 60 / (1.5 * node.interval));
  for (std::size_t i = 1; i < begins.size(); ++i) {
    EXPECT_GE(begins[i] - begins[i - 1], 0.5 * node.interval - 0.02);
    EXPECT_LE(begins[i] - begins[i - 1], 1.5 * node.interval + 0.02);
  }
}

TEST(Eyes, ShutNoFurtherThanTheyReach) {
  const auto& m = blinking_model();
  auto node = eyes_from(EyeSource::blinking);
  node.reach = 3;
  const auto eyes = make(node, m, random_track(m, 1000 * 20, 1, Rational(1000)));
  // The likeliest parameters at three standard deviations of one linear measure lie as far out, by Mahalanobis.
  const Eigen::MatrixXd scaled = eyes.parameters.values * m.combined_variances.cwiseSqrt().cwiseInverse().asDiagonal();
  EXPECT_NEAR(scaled.rowwise().norm().maxCoeff(), 3, 1e-3);
}

// Of all parameters whose lids meet, the shut eyes' are the likeliest.
TEST(Eyes, ShutOnesAreTheLikeliest) {
  const auto& m = blinking_model();
  const auto eyes = make(eyes_from(EyeSource::blinking), m, random_track(m, 1000 * 20, 1, Rational(1000)));
  Eigen::Index at = 0;
  eyes.parameters.values.rowwise().squaredNorm().maxCoeff(&at);
  const Eigen::VectorXd shut = eyes.parameters.values.row(at);
  const auto unlikely = [&](const Eigen::VectorXd& c) {
    return (c.array().square() / m.combined_variances.array()).sum();
  };
  const double now = gap(m, shut);
  Random random(5);
  Eigen::VectorXd along = Eigen::VectorXd::Zero(m.modes());
  for (Eigen::Index d = 0; d < along.size(); ++d)
    along(d) = 0.5 * (gap(m, Eigen::VectorXd::Unit(along.size(), d)) - gap(m, -Eigen::VectorXd::Unit(along.size(), d)));
  for (int i = 0; i < 50; ++i) {
    Eigen::VectorXd step(m.modes());
    for (auto& v : step) v = 1e-3 * random.normal();
    step -= along * along.dot(step) / along.squaredNorm();
    EXPECT_NEAR(gap(m, shut + step), now, 1e-6);
    EXPECT_GE(unlikely(shut + step), unlikely(shut));
  }
}

TEST(Eyes, AreFoundByThePointScheme) {
  AppearanceModel m;
  m.scheme = "ibug68";
  m.mean_shape = find_scheme("ibug68")->mean;
  m.combined_variances = Eigen::VectorXd::Ones(1);
  m.shape_per_mode = Eigen::MatrixXd::Zero(136, 1);
  MakeEyes node;
  node.source = EyeSource::still;
  const Track track{Eigen::MatrixXd::Zero(2, 1), Rational(25), 0.02, {}};
  const auto eyes = make(node, m, track);
  EXPECT_EQ(eyes.points, (std::vector<int>{36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47}));
  EXPECT_EQ(eyes.nose, (std::vector<int>{27, 28, 29, 30, 31, 32, 33, 34, 35}));
  double gap = 0;
  for (const auto& [upper, lower] : {std::pair{37, 41}, {38, 40}, {43, 47}, {44, 46}}) {
    gap += m.mean_shape(lower, 1) - m.mean_shape(upper, 1);
    m.shape_per_mode(2 * upper + 1, 0) = 1;  // a unit of c brings each upper lid down by one
  }
  node.source = EyeSource::blinking;
  node.interval = 0.4;
  node.reach = 1000;
  const Track longer{Eigen::MatrixXd::Zero(1000, 1), Rational(1000), 0, {}};
  EXPECT_NEAR(make(node, m, longer).parameters.values.maxCoeff(), gap / 4, 0.01 * gap);
}

TEST(Eyes, OfASchemeWithoutThemLieBetweenBrowsAndNose) {
  AppearanceModel m;
  m.scheme = "face56";
  const auto scheme = *find_scheme("face56");
  m.mean_shape = scheme.mean;
  m.combined_variances = Eigen::VectorXd::Ones(1);
  m.shape_per_mode = Eigen::MatrixXd::Zero(2 * m.points(), 1);
  MakeEyes node;
  node.source = EyeSource::still;
  const Track track{Eigen::MatrixXd::Zero(200, 1), Rational(25), 0.02, {}};
  const auto points = make(node, m, track).points;
  for (const char* brow : {"left_brow", "right_brow"})
    for (const int i : scheme.named(brow)) EXPECT_EQ(std::count(points.begin(), points.end(), i), 1);
  const double nose = m.mean_shape.col(1)(scheme.named("nose_base")).minCoeff(),
               brows = m.mean_shape.col(1)(scheme.named("left_brow")).maxCoeff();
  EXPECT_GT(below_eyes(m), brows);
  EXPECT_LT(below_eyes(m), nose);
  node.source = EyeSource::blinking;
  EXPECT_THAT(complaint([&] { make(node, m, track); }), testing::HasSubstr("name the landmarks of the lids"));
}

/// The model, its points known by name.
AppearanceModel named_model() {
  AppearanceModel m = model();
  Json mean = Json::array();
  for (const auto& point : m.mean_shape.rowwise()) mean.push_back({point.x(), point.y()});
  m.scheme = Json{
      {"name", "synthetic"},
      {"groups",
       {{{"name", "left_eye"}, {"points", {16, 17, 18, 19}}}, {{"name", "right_eye"}, {"points", {20, 21, 22, 23}}}}},
      {"mean",
       mean}}.dump();
  return m;
}

cv::Rect drawn(const cv::Mat& picture) {
  cv::Mat differs = picture != cv::Scalar::all(128), any;
  cv::cvtColor(differs, any, cv::COLOR_BGR2GRAY);
  return cv::boundingRect(any);
}

TEST(Render, FillsSquarePictures) {
  RenderFace node;
  node.size = 120;
  const Track still{Eigen::MatrixXd::Zero(1, model().modes()), Rational(25), 0.02, {}};
  const auto picture = node(model(), still, nullptr, nullptr).read_all().at(0);
  ASSERT_EQ(picture.size(), cv::Size(120, 120));
  const auto face = drawn(picture);
  EXPECT_NEAR(std::max(face.width, face.height), 100, 3);
  EXPECT_NEAR(face.x + 0.5 * face.width, 60, 2);
  EXPECT_NEAR(face.y + 0.5 * face.height, 60, 2);
}

TEST(Render, ShowsWhatLiesBelowTheEyes) {
  const auto m = named_model();
  RenderFace node;
  node.size = 120;
  node.part = FacePart::lower;
  const Track moving = random_track(m, 3, 1);
  for (const auto& picture : node(m, moving, nullptr, nullptr).read_all()) {
    const auto face = drawn(picture);
    const Eigen::RowVector2d low = m.mean_shape.colwise().minCoeff(), high = m.mean_shape.colwise().maxCoeff();
    const double zoom = 100 / std::max(high.x() - low.x(), high.y() - below_eyes(m));
    EXPECT_NEAR(face.y, 60 - 0.5 * zoom * (high.y() - below_eyes(m)), 1.5);
    EXPECT_GT(face.width, 60);
  }
  EXPECT_GT(below_eyes(m), m.mean_shape.col(1)(left_and_right_eye).maxCoeff());
  EXPECT_THAT(complaint([&] { node(model(), moving, nullptr, nullptr); }), testing::HasSubstr("synthetic"));
}

TEST(LidClosure, GoesDownFasterThanUp) {
  EXPECT_EQ(lid_closure(-0.1, 0.3), 0);
  EXPECT_EQ(lid_closure(0.3, 0.3), 0);
  EXPECT_NEAR(lid_closure(0.1, 0.3), 1, 1e-12);
  EXPECT_NEAR(lid_closure(0.05, 0.3), 0.5, 1e-12);
  EXPECT_NEAR(lid_closure(0.2, 0.3), 0.5, 1e-12);
}

TEST(Eyes, GivenOnesAreHeldAtTheirLastFrame) {
  const Track own = random_track(model(), 4, 1), given = random_track(model(), 2, 2);
  const auto eyes = make(eyes_from(EyeSource::given), model(), own, &given);
  for (int t = 0; t < 4; ++t)
    EXPECT_LT((eyes.parameters.values.row(t) - given.values.row(std::min(t, 1))).norm(), 1e-12);
}

TEST(Eyes, GivenOnesAreTakenAtTheSameTime) {
  const Track own = random_track(model(), 8, 1, Rational(50)), given = random_track(model(), 4, 2, Rational(25));
  const auto eyes = make(eyes_from(EyeSource::given), model(), own, &given);
  const auto& v = given.values;
  const auto expect = [&](int t, const Eigen::RowVectorXd& wanted) {
    EXPECT_LT((eyes.parameters.values.row(t) - wanted).norm(), 1e-12) << t;
  };
  expect(0, v.row(0));  // 0.01 s, before the first given frame's middle
  expect(1, 0.75 * v.row(0) + 0.25 * v.row(1));
  expect(2, 0.25 * v.row(0) + 0.75 * v.row(1));
  expect(5, 0.75 * v.row(2) + 0.25 * v.row(3));
  expect(7, v.row(3));
}

TEST(Eyes, SayWhatTheyLack) {
  const Track track = random_track(model(), 200, 1), none = random_track(model(), 0, 1);
  const auto error = [&](MakeEyes node, const Track* given = nullptr) {
    return complaint([&] { make(node, model(), track, given); });
  };
  EXPECT_THAT(error(eyes_from(EyeSource::given)), testing::HasSubstr("wire their parameters"));
  EXPECT_THAT(error(eyes_from(EyeSource::given), &none), testing::HasSubstr("wire their parameters"));
  EXPECT_THAT(error(eyes_from(EyeSource::blinking)), testing::HasSubstr("lids never move"));
  MakeEyes of_other_points;
  of_other_points.source = EyeSource::still;
  EXPECT_THAT(error(of_other_points), testing::HasSubstr("synthetic"));
  of_other_points.points = {16, 36};
  EXPECT_THAT(error(of_other_points), testing::HasSubstr("has 36 points and so no point 36"));
  of_other_points.points = {16, 20};
  of_other_points.source = EyeSource::blinking;
  EXPECT_THAT(error(of_other_points), testing::HasSubstr("name the landmarks of the lids"));
  auto node = eyes_from(EyeSource::still);
  node.lower_lids.pop_back();
  EXPECT_THAT(error(node), testing::HasSubstr("2 points of upper lids, but 1"));
}

TEST(Looks, ShowTheEyesOfOthersInABandAndTheirPointsAligned) {
  const auto& m = blinking_model();
  const Track own = random_track(m, 2, 1), other = random_track(m, 2, 2);
  const auto eyes = make(eyes_from(EyeSource::given), m, own, &other);
  const Looks looks(m, own, &eyes, nullptr);
  const auto& raster = m.levels[0].raster;
  for (int t = 0; t < 2; ++t) {
    const Look look = looks.at(t);
    const Eigen::VectorXf texture = m.texture(own.values.row(t)), of_eyes = m.texture(other.values.row(t));
    int taken = 0, kept = 0;
    for (std::size_t i = 0; i < raster.x.size(); ++i) {
      const float share = looks.eye_share().at<float>(raster.y[i], raster.x[i]);
      const auto at = static_cast<Eigen::Index>(3 * i);
      taken += share == 1;
      kept += share == 0;
      EXPECT_LT((look.texture.segment<3>(at) - (1 - share) * texture.segment<3>(at) - share * of_eyes.segment<3>(at))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-6);
    }
    EXPECT_GT(taken, 100);
    EXPECT_GT(kept, 100);
    const Shape before = m.shape(own.values.row(t)), source = m.shape(other.values.row(t));
    std::vector<int> moved = left_and_right_eye;
    moved.insert(moved.end(), nose.begin(), nose.end());
    const Shape aligned = transform(align(source(moved, Eigen::all), before(moved, Eigen::all)), source);
    for (int i = 0; i < before.rows(); ++i) {
      const bool moves = std::find(moved.begin(), moved.end(), i) != moved.end();
      EXPECT_LT((look.shape.row(i) - (moves ? aligned : before).row(i)).norm(), 1e-9);
    }
  }
}

TEST(Looks, AreTheSameInBlocksAndAlone) {
  const Track track = random_track(model(), 37, 1);
  const auto looks = std::make_shared<Looks>(model(), track, nullptr, nullptr);
  LookReader reader(looks);
  for (int t = 0; t < 37; ++t) {
    const Look* look = reader.next();
    ASSERT_TRUE(look);
    EXPECT_EQ(look->shape, model().shape(track.values.row(t)));
    EXPECT_LT((look->texture - model().texture(track.values.row(t))).norm(), 1e-5);
  }
  EXPECT_FALSE(reader.next());
}

TEST(Looks, OwnEyesChangeNothing) {
  const Track track = random_track(model(), 1, 1);
  const auto eyes = make(eyes_from(EyeSource::given), model(), track, &track);
  const Look with = Looks(model(), track, &eyes, nullptr).at(0),
             without = Looks(model(), track, nullptr, nullptr).at(0);
  EXPECT_LT((with.shape - without.shape).norm(), 1e-9);
  EXPECT_LT((with.texture - without.texture).norm(), 1e-5);
}

TEST(Looks, RefuseWhatDoesNotFit) {
  const Track track = random_track(model(), 2, 1);
  const auto error = [](const Track& parameters, const Eyes* eyes, const MouthTrack* mouths) {
    return complaint([&] { Looks(model(), parameters, eyes, mouths); });
  };
  Track other = track;
  other.values.conservativeResize(2, track.dimension() - 1);
  EXPECT_THAT(error(other, nullptr, nullptr), testing::HasSubstr("another model"));
  other = track;
  other.values(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error(other, nullptr, nullptr), testing::HasSubstr("not a number"));
  const Eyes nan{other, left_and_right_eye, nose}, few{random_track(model(), 1, 1), left_and_right_eye, nose},
      far{track, {99}, {}};
  EXPECT_THAT(error(track, &nan, nullptr), testing::HasSubstr("not a number"));
  EXPECT_THAT(error(track, &few, nullptr), testing::HasSubstr("eyes are of 1 frames, the appearance parameters of 2"));
  EXPECT_THAT(error(track, &far, nullptr), testing::HasSubstr("no point 99"));
  MouthTrack short_one;
  short_one.chosen = {0};
  EXPECT_THAT(error(track, nullptr, &short_one), testing::HasSubstr("mouths are of 1 frames"));
  MouthTrack none_there;
  none_there.mouths.points = mouth;
  none_there.mouths.parameters.resize(0, model().modes());
  none_there.chosen = {0, 0};
  EXPECT_THAT(error(track, nullptr, &none_there), testing::HasSubstr("mouth 0 is to be shown, of 0"));
}

Video clip(int frames, double gain = 1, double offset = 0) {
  std::vector<cv::Mat> all;
  for (int t = 0; t < frames; ++t) {
    auto face = test::talking_face(t);
    face.gain = gain;
    face.offset = offset;
    all.push_back(test::draw(face));
  }
  return video_from_frames(all, Rational(25));
}

FaceTrack track(const Video& video) {
  Context context;
  return TrackFace{}(model(), video, context);
}

Mouths keep(KeepMouths node, const Video& video, const FaceTrack& of_video) {
  node.points = mouth;
  Context context;
  return node(model(), {{"a", video}}, {{"a", of_video}}, context);
}

TEST(KeepMouths, KeepsPicturesInAverageLight) {
  KeepMouths all;
  all.leave_out = 0;
  const Video plain = clip(6), dim = clip(6, 0.7, 20);
  const auto a = keep(all, plain, track(plain)), b = keep(all, dim, track(dim));
  ASSERT_EQ(a.size(), 6);
  ASSERT_EQ(b.size(), 6);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(a.pictures[i].pixels.size(), a.pictures[0].pixels.size());
    EXPECT_GT(test::psnr(a.pictures[i].pixels, b.pictures[i].pixels), 35);
  }
}

TEST(KeepMouths, KeepsAsManyAsItMayEvenlySpread) {
  KeepMouths node;
  node.points = mouth;
  node.leave_out = 0;
  node.limit = 4;
  const Video video = clip(6);
  const auto seen = track(video);
  Context context;
  const auto few = node(model(), {{"a", video}, {"b", video}}, {{"a", seen}, {"b", seen}}, context);
  ASSERT_EQ(few.size(), 4);
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(few.parameters.row(i), seen.parameters.values.row(std::vector<int>{0, 3, 0, 3}[i])) << i;
}

TEST(KeepMouths, LeavesOutLostFramesAndTheWorstFitted) {
  const Video video = clip(5);
  auto seen = track(video);
  seen.lost[0] = 1;
  seen.residual = {0, 1, 9, 1, 1};
  KeepMouths node;
  node.leave_out = 0.25;  // one of four
  EXPECT_EQ(keep(node, video, seen).size(), 3);
  seen.lost.assign(5, 1);
  EXPECT_EQ(keep(node, video, seen).size(), 0);
  node.limit = 0;
  EXPECT_EQ(keep(node, video, track(video)).size(), 0);
}

TEST(KeepMouths, JudgesAFitByItsContrast) {
  const Video video = clip(4);
  auto seen = track(video);
  seen.residual = {2, 2, 1.5, 2};
  seen.gain = {1000, 1000, 500, 1000};  // the third is dim
  KeepMouths node;
  node.leave_out = 0.25;
  const auto kept = keep(node, video, seen);
  ASSERT_EQ(kept.size(), 3);
  EXPECT_EQ(kept.parameters.row(2), seen.parameters.values.row(3));
}

TEST(KeepMouths, NamesThePointThatIsMissing) {
  Context context;
  EXPECT_THAT(complaint([&] { KeepMouths{}(model(), {}, {}, context); }), testing::HasSubstr("synthetic"));
  KeepMouths node;
  node.points = {28, 32, 48};
  EXPECT_THAT(complaint([&] { node(model(), {}, {}, context); }),
              testing::HasSubstr("has 36 points and so no point 48"));
  node.points = {28, 32};
  EXPECT_THAT(complaint([&] { node(model(), {}, {}, context); }), testing::HasSubstr("span no area"));
}

TEST(Mouths, ComeBackFromAFile) {
  const Video video = clip(3);
  KeepMouths node;
  node.leave_out = 0;
  for (auto mouths : {keep(node, video, track(video)), Mouths{}}) {
    const test::TemporaryFolder folder;
    const std::string file = (folder.path() / "mouths.h5").string();
    write_hdf5(file, [&](Archive& ar) { fields(ar, mouths); });
    Mouths back;
    fields(*hdf5_reader(file), back);
    EXPECT_EQ(back.points, mouths.points);
    EXPECT_EQ(back.parameters, mouths.parameters);
    ASSERT_EQ(back.pictures.size(), mouths.pictures.size());
    for (std::size_t i = 0; i < back.pictures.size(); ++i)
      EXPECT_EQ(cv::norm(back.pictures[i].pixels, mouths.pictures[i].pixels, cv::NORM_INF), 0);
  }
}

class RealMouths : public testing::Test {
 protected:
  RealMouths() {
    KeepMouths node;
    node.leave_out = 0;
    mouths = keep(node, video, seen);
  }
  MouthTrack select(double smoothness, const Track& parameters) const {
    SelectMouths node;
    node.smoothness = smoothness;
    return node(model(), mouths, parameters);
  }

  const Video video = clip(8);
  const FaceTrack seen = track(video);
  Mouths mouths;
};

TEST_F(RealMouths, AreTheFramesOwnIfTheyAreThere) {
  EXPECT_EQ(select(0, seen.parameters).chosen, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(RealMouths, DoNotChangeWhereStepsCostTooMuch) {
  const auto chosen = select(1e9, seen.parameters).chosen;
  EXPECT_EQ(chosen, std::vector<std::int64_t>(8, chosen[0]));
}

TEST_F(RealMouths, AreShownInTheFace) {
  const auto own = select(0, seen.parameters);
  const BaseClip base = MakeBaseClip{}(video, seen);
  const auto drawn = CompositeFace{}(model(), seen.parameters, base, nullptr, &own).read_all();
  const auto real = video.read_all();
  for (std::size_t t = 0; t < real.size(); ++t) EXPECT_GT(test::psnr(drawn[t], real[t]), 38) << t;

  auto other = own;
  for (auto& picture : other.mouths.pictures)
    picture.pixels = cv::Mat(picture.pixels.size(), CV_8UC3, cv::Scalar(0, 255, 0));
  const auto green = CompositeFace{}(model(), seen.parameters, base, nullptr, &other).read_all();
  const Shape& shape = seen.shapes[0];
  const Eigen::RowVector2d middle = shape(mouth, Eigen::all).colwise().mean();
  const cv::Point at(static_cast<int>(middle.x()), static_cast<int>(middle.y()));
  EXPECT_LE(cv::norm(green[0].at<cv::Vec3b>(at), cv::Vec3b(0, 255, 0), cv::NORM_INF), 12);
  EXPECT_EQ(cv::norm(green[0].rowRange(0, 90), drawn[0].rowRange(0, 90), cv::NORM_INF), 0);
  EXPECT_NE(RenderFace{}(model(), seen.parameters, nullptr, &other).source->key(),
            RenderFace{}(model(), seen.parameters, nullptr, &own).source->key());
}

TEST_F(RealMouths, OfAnEmptyStoreAreNone) {
  const auto none = SelectMouths{}(model(), Mouths{}, seen.parameters);
  EXPECT_TRUE(none.chosen.empty());
  const BaseClip base = MakeBaseClip{}(video, seen);
  EXPECT_EQ(cv::norm(CompositeFace{}(model(), seen.parameters, base, nullptr, &none).read_all()[0],
                     CompositeFace{}(model(), seen.parameters, base, nullptr, nullptr).read_all()[0], cv::NORM_INF),
            0);
}

TEST_F(RealMouths, TakeAnyLengthAndRefuseWhatIsNoNumber) {
  Track one = seen.parameters;
  one.values = one.values.topRows(1).eval();
  EXPECT_EQ(select(1, one).chosen, std::vector<std::int64_t>{0});
  one.values(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(select(1, one), std::runtime_error);
  one.values.resize(0, model().modes());
  EXPECT_TRUE(select(1, one).chosen.empty());
  Mouths foreign = mouths;
  foreign.parameters.conservativeResize(foreign.size(), 1);
  EXPECT_THROW(SelectMouths{}(model(), foreign, seen.parameters), std::runtime_error);
  foreign = mouths;
  foreign.pictures[5].pixels = foreign.pictures[5].pixels.colRange(1, 9);
  EXPECT_THROW(SelectMouths{}(model(), foreign, seen.parameters), std::runtime_error);
  foreign = mouths;
  foreign.pictures.pop_back();
  EXPECT_THROW(SelectMouths{}(model(), foreign, seen.parameters), std::runtime_error);
}

TEST(CompositeFace, ShowsTheEyesThatAreGiven) {
  const auto& m = blinking_model();
  const Video video = clip(1);
  Context context;
  const FaceTrack seen = TrackFace{}(m, video, context);
  const BaseClip base = MakeBaseClip{}(video, seen);
  Track shut = seen.parameters;
  shut.values = make(eyes_from(EyeSource::blinking), m, random_track(m, 5000, 1, Rational(1000))).parameters.values;
  Eigen::Index at = 0;
  shut.values.rowwise().squaredNorm().maxCoeff(&at);
  shut.values = shut.values.row(at).eval();
  const Eyes eyes{shut, left_and_right_eye, nose};
  const auto with = CompositeFace{}(m, seen.parameters, base, &eyes, nullptr).read_all()[0],
             without = CompositeFace{}(m, seen.parameters, base, nullptr, nullptr).read_all()[0];
  const cv::Rect at_eyes(70, 70, 60, 20);
  EXPECT_GT(cv::norm(with(at_eyes), without(at_eyes), cv::NORM_INF), 20);
  EXPECT_EQ(cv::norm(with.rowRange(160, 200), without.rowRange(160, 200), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace talkgraph
