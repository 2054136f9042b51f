#include "nodes/face/fit.h"

#include <gtest/gtest.h>

#include <set>

#include "nodes/face/build.h"
#include "nodes/face/geometry.h"
#include "nodes/face/steepest_descent.h"
#include "synthetic_face.h"

namespace talkgraph {
namespace {

using test::model;

Fit mean_at(const AppearanceModel& model, const Shape& place) {
  Fit start;
  start.c = Eigen::VectorXd::Zero(model.modes());
  start.pose = align(model.mean_shape, place);
  return start;
}

Shape shape_of(const AppearanceModel& model, const Fit& fit) { return transform(fit.pose, model.shape(fit.c)); }

bool is_finite(const Fit& f) {
  return f.c.allFinite() && std::isfinite(f.pose.scale) && std::isfinite(f.pose.angle) && std::isfinite(f.pose.dx) &&
         std::isfinite(f.pose.dy) && std::isfinite(f.gain) && std::isfinite(f.offset) && std::isfinite(f.error) &&
         std::isfinite(f.residual) && std::isfinite(f.detail);
}

/// Smooth enough for its gradient to hold over a pixel.
cv::Mat smooth_picture() {
  cv::Mat picture(120, 140, CV_32FC3);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture.at<cv::Vec3f>(y, x) =
          cv::Vec3f(static_cast<float>(100 + 50 * std::sin(0.05 * x + 0.02 * y)),
                    static_cast<float>(90 + 40 * std::cos(0.04 * y)), static_cast<float>(x + 0.5 * y));
  return picture;
}

TEST(SteepestDescent, AgreesWithFiniteDifferences) {
  const Shape& mean = model().mean_shape;
  const Raster raster = make_raster(mean, model().triangles, 1);
  const Sampler sample(raster, model().triangles);
  Eigen::VectorXd c = 0.7 * model().combined_variances.cwiseSqrt();
  const Shape shape = model().shape(c);
  Eigen::MatrixXd directions(2 * mean.rows(), model().shape_modes.cols() + 4);
  directions << model().shape_modes, pose_directions(shape);
  const Pose pose{1.05, 0.1, 70, 58};
  Pyramid pyramid(smooth_picture());
  Eigen::VectorXf texture, forth, back;
  sample(pyramid, transform(pose, shape), texture);
  Eigen::MatrixXf images(texture.size(), directions.cols());
  SteepestDescent(raster, model().triangles)(shape, directions, texture, images);
  for (Eigen::Index j = 0; j < directions.cols(); ++j) {
    const double h = 0.5 / directions.col(j).cwiseAbs().maxCoeff();
    const Shape step = unflatten(h * directions.col(j));
    sample(pyramid, transform(pose, shape + step), forth);
    sample(pyramid, transform(pose, shape - step), back);
    const Eigen::VectorXf measured = (forth - back) / static_cast<float>(2 * h);
    EXPECT_LT((images.col(j) - measured).norm(), 0.05 * measured.norm()) << j;
  }
}

TEST(SteepestDescent, IsExactWhereAPictureIsLinear) {
  cv::Mat picture(60, 80, CV_32FC3);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      picture.at<cv::Vec3f>(y, x) =
          cv::Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(2 * x - y));
  Shape mean(4, 2);
  mean << -10, -10, 12, -9, 11, 10, -9, 12;
  const auto triangles = delaunay(mean);
  const auto raster = make_raster(mean, triangles, 1);
  const Shape shape = transform({1.3, 0.4, 0, 0}, mean);
  Pyramid pyramid(picture);
  Eigen::VectorXf texture;
  Sampler(raster, triangles)(pyramid, transform({1, 0, 40, 30}, shape), texture);
  Eigen::MatrixXf images(texture.size(), 4);
  SteepestDescent(raster, triangles)(shape, pose_directions(shape), texture, images);
  std::set<std::pair<int, int>> pixels;
  for (std::size_t i = 0; i < raster.x.size(); ++i) pixels.insert({raster.x[i], raster.y[i]});
  int compared = 0;
  for (Eigen::Index i = 0; i < raster.size(); ++i) {
    const int x = raster.x[static_cast<std::size_t>(i)], y = raster.y[static_cast<std::size_t>(i)];
    const bool tip = !(pixels.contains({x - 1, y}) || pixels.contains({x + 1, y})) ||
                     !(pixels.contains({x, y - 1}) || pixels.contains({x, y + 1}));
    if (tip) continue;  // it has no neighbour to tell how it changes
    ++compared;
    EXPECT_NEAR(images(3 * i, 2), 1, 1e-4);
    EXPECT_NEAR(images(3 * i + 1, 2), 0, 1e-4);
    EXPECT_NEAR(images(3 * i + 2, 2), 2, 1e-4);
    EXPECT_NEAR(images(3 * i + 2, 3), -1, 1e-4);
    EXPECT_NEAR(images(3 * i, 0), texture(3 * i) - 40, 1e-3);
    EXPECT_NEAR(images(3 * i, 1), -(texture(3 * i + 1) - 30), 1e-3);
  }
  EXPECT_GT(compared, raster.size() - 8);
}

TEST(Fitter, MeasuresAFitAsTexturesThatAreMade) {
  const auto face = test::talking_face(5);
  Pyramid pyramid(test::draw(face));
  for (std::size_t level = 0; level < model().levels.size(); ++level) {
    Fit fit = mean_at(model(), test::landmarks(face));
    fit.c = 0.3 * model().combined_variances.cwiseSqrt();
    Fitter(model()).evaluate(pyramid, level, fit);
    Eigen::VectorXf seen;
    sample(pyramid, shape_of(model(), fit), model().triangles, model().levels[level].raster, seen);
    const Eigen::VectorXd picture = seen.cast<double>(), own = model().texture(fit.c, level).cast<double>();
    const Eigen::VectorXd centred = picture.array() - picture.mean();
    const double gain = centred.squaredNorm() / centred.dot(own);  // as the picture is scaled to the model
    EXPECT_NEAR(fit.offset, picture.mean(), 1e-3);
    EXPECT_NEAR(fit.error, 1 - std::pow(centred.dot(own), 2) / (centred.squaredNorm() * own.squaredNorm()), 1e-5);
    EXPECT_NEAR(fit.gain, centred.dot(own) / own.squaredNorm(), 1e-3 * gain);
    EXPECT_NEAR(fit.residual, (centred - fit.gain * own).norm() / std::sqrt(static_cast<double>(own.size())), 1e-2);
    using Channels = Eigen::Matrix<double, 3, Eigen::Dynamic>;
    Channels a = Eigen::Map<const Channels>(centred.data(), 3, own.size() / 3),
             b = Eigen::Map<const Channels>(own.data(), 3, own.size() / 3);
    a.colwise() -= a.rowwise().mean().eval();
    b.colwise() -= b.rowwise().mean().eval();
    EXPECT_NEAR(fit.detail, a.cwiseProduct(b).sum() / (a.norm() * b.norm()), 1e-4);
  }
}

class FitBy : public testing::TestWithParam<FitMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, FitBy, testing::Values(FitMethod::fixed_jacobian, FitMethod::inverse_compositional));

TEST_P(FitBy, ConvergesFromAPerturbedStart) {
  Fitter fitter(model(), GetParam());
  for (const double push : {-5.0, 4.0})
    for (int t = 0; t < 8; ++t) {
      const auto face = test::talking_face(t);
      Pyramid pyramid(test::draw(face));
      Fit start = mean_at(model(), test::landmarks(face));
      start.pose.dx += push;
      start.pose.dy -= push / 2;
      start.pose.scale *= 1.05;
      const Fit found = fitter.coarse_to_fine(pyramid, start, {30, 1e-4, 4});
      EXPECT_LT(test::rms_distance(shape_of(model(), found), test::landmarks(face)), 0.5) << t;
    }
}

TEST_P(FitBy, FindsGainAndOffset) {
  Fitter fitter(model(), GetParam());
  auto face = test::talking_face(3);
  Pyramid plain(test::draw(face));
  face.gain = 0.6;
  face.offset = 40;
  Pyramid dim(test::draw(face));
  const Fit start = mean_at(model(), test::landmarks(face));
  const Fit a = fitter.fit(plain, 0, start), b = fitter.fit(dim, 0, start);
  EXPECT_NEAR(b.gain, 0.6 * a.gain, 0.02 * a.gain);
  EXPECT_NEAR(b.offset, 0.6 * a.offset + 40, 1);
}

TEST_P(FitBy, NeverWorsensAndDependsOnItsArgumentsAlone) {
  Fitter used(model(), GetParam());
  for (int t = 0; t < 4; ++t) {
    const auto face = test::talking_face(t);
    Pyramid pyramid(test::draw(face));
    Fit start = mean_at(model(), test::landmarks(face));
    start.pose.dx += 3 * t;
    used.evaluate(pyramid, 0, start);
    const Fit found = used.fit(pyramid, 0, start);
    EXPECT_LE(found.error, start.error);
    const Fit again = Fitter(model(), GetParam()).fit(pyramid, 0, start);
    EXPECT_EQ(found.c, again.c);
    EXPECT_EQ(found.error, again.error);
  }
}

TEST_P(FitBy, ReachesFurtherWithOtherStarts) {
  Fitter fitter(model(), GetParam());
  for (const int t : {0, 2, 5}) {
    const auto face = test::talking_face(t);
    Pyramid pyramid(test::draw(face));
    Fit start = mean_at(model(), test::landmarks(face));
    start.pose.dx += 34;
    const auto distance = [&](double reach) {
      const Fit found = fitter.coarse_to_fine(pyramid, start, {.reach = reach});
      return test::rms_distance(shape_of(model(), found), test::landmarks(face));
    };
    EXPECT_GT(distance(0), 5) << t;
    EXPECT_LT(distance(0.3), 0.5) << t;
  }
}

TEST_P(FitBy, ARigidModelFindsItsPose) {
  auto prototypes = test::synthetic_prototypes();
  prototypes.images.resize(1);
  prototypes.shapes.resize(1);
  Context context;
  const auto rigid = BuildAppearance{}(prototypes, context);
  Pyramid pyramid(prototypes.images[0].pixels);
  Fit start = mean_at(rigid, prototypes.shapes[0]);
  start.pose.dx += 3;
  start.pose.angle += 0.03;
  const Fit found = Fitter(rigid, GetParam()).coarse_to_fine(pyramid, start, {30, 1e-4, 4});
  EXPECT_LT(test::rms_distance(shape_of(rigid, found), prototypes.shapes[0]), 0.1);
}

TEST_P(FitBy, IsFiniteWhereThereIsNoFace) {
  const auto face = test::talking_face(0);
  const cv::Mat drawn = test::draw(face);
  for (const cv::Mat& picture :
       {cv::Mat(100, 100, CV_8UC3, cv::Scalar(9, 90, 40)), cv::Mat(1, 1, CV_8UC3, cv::Scalar(1)),
        cv::Mat(3, 70, CV_8UC3, cv::Scalar(7)), cv::Mat(drawn.colRange(0, 100)), cv::Mat(drawn.rowRange(95, 200))}) {
    Pyramid pyramid(picture);
    const Fit found = Fitter(model(), GetParam()).coarse_to_fine(pyramid, mean_at(model(), test::landmarks(face)));
    EXPECT_TRUE(is_finite(found)) << picture.size();
    EXPECT_GE(found.error, 0);
    EXPECT_LE(found.error, 1);
  }
}

}  // namespace
}  // namespace talkgraph
