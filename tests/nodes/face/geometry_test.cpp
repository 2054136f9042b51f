#include "nodes/face/geometry.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "graph/random.h"
#include "nodes/face/pca.h"
#include "nodes/face/sampling.h"
#include "synthetic_face.h"

namespace talkgraph {
namespace {

Shape random_shape(Random& random, int points) {
  Shape s(points, 2);
  for (int i = 0; i < points; ++i) s.row(i) << random.uniform(-10, 10), random.uniform(-10, 10);
  return s;
}

TEST(Geometry, AlignRecoversASimilarity) {
  Random random(3);
  const Shape s = random_shape(random, 9);
  const Pose pose{1.7, 0.6, 12, -5};
  const auto found = align(s, transform(pose, s));
  EXPECT_NEAR(found.scale, 1.7, 1e-12);
  EXPECT_NEAR(found.angle, 0.6, 1e-12);
  EXPECT_NEAR(found.dx, 12, 1e-11);
  EXPECT_NEAR(found.dy, -5, 1e-11);
}

TEST(Geometry, ComposeAppliesTheInnerPoseFirst) {
  Random random(4);
  const Shape s = random_shape(random, 5);
  const Pose a{1.2, 0.3, 4, 5}, b{0.7, -1, 2, -3};
  EXPECT_LT((transform(compose(a, b), s) - transform(a, transform(b, s))).norm(), 1e-12);
}

TEST(Geometry, ProcrustesUndoesSimilarities) {
  Random random(5);
  const Shape s = random_shape(random, 12);
  std::vector<Shape> shapes;
  for (int i = 0; i < 6; ++i)
    shapes.push_back(transform({random.uniform(0.5, 2), random.uniform(-0.5, 0.5), random.uniform(-9, 9), 3}, s));
  const auto aligned = procrustes(shapes, 100);
  EXPECT_NEAR(aligned.mean.col(0).maxCoeff() - aligned.mean.col(0).minCoeff(), 100, 1e-6);
  EXPECT_LT(aligned.mean.colwise().mean().norm(), 1e-9);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_LT((aligned.shapes[i] - aligned.mean).norm(), 1e-6);
    EXPECT_LT((transform(aligned.poses[i], aligned.mean) - shapes[i]).norm(), 1e-6);
  }
}

TEST(Geometry, ProcrustesPosesLeadBackToTheGivenShapes) {
  Random random(9);
  std::vector<Shape> shapes;
  const Shape s = random_shape(random, 12);
  for (int i = 0; i < 6; ++i)
    shapes.push_back(transform({random.uniform(0.5, 2), random.uniform(-0.5, 0.5), random.uniform(-9, 9), 3},
                               s + 0.2 * random_shape(random, 12)));
  const auto aligned = procrustes(shapes, 100);
  for (std::size_t i = 0; i < shapes.size(); ++i)
    EXPECT_LT((transform(aligned.poses[i], aligned.shapes[i]) - shapes[i]).norm(), 1e-9) << i;
}

TEST(Geometry, InverseUndoesAPose) {
  Random random(10);
  const Shape s = random_shape(random, 5);
  const Pose pose{1.2, 0.3, 4, 5};
  EXPECT_LT((transform(inverse(pose), transform(pose, s)) - s).norm(), 1e-12);
  EXPECT_LT((transform(pose, transform(inverse(pose), s)) - s).norm(), 1e-12);
}

TEST(Geometry, ProcrustesRefusesCoincidingPoints) {
  EXPECT_THROW(procrustes({Shape::Zero(4, 2)}, 100), std::runtime_error);
}

TEST(Geometry, DelaunayCirclesAreEmpty) {
  Random random(6);
  const Shape p = random_shape(random, 25);
  const auto triangles = delaunay(p);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector2d a = p.row(triangles(t, 0)), b = p.row(triangles(t, 1)), c = p.row(triangles(t, 2));
    Eigen::Matrix2d m;
    m << (b - a).transpose(), (c - a).transpose();
    const Eigen::Vector2d centre =
        a + m.inverse() * (0.5 * Eigen::Vector2d((b - a).squaredNorm(), (c - a).squaredNorm()));
    for (Eigen::Index i = 0; i < p.rows(); ++i)
      EXPECT_GE((p.row(i).transpose() - centre).norm(), (a - centre).norm() * (1 - 1e-6));
  }
}

TEST(Geometry, DelaunayOfAGridCoversItOnce) {
  Shape grid(20, 2);
  for (int i = 0; i < 20; ++i) grid.row(i) << i % 5, i / 5;
  const auto triangles = delaunay(grid);
  double area = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector2d a = grid.row(triangles(t, 0)), b = grid.row(triangles(t, 1)),
                             c = grid.row(triangles(t, 2));
    area += 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  }
  EXPECT_NEAR(area, 12, 1e-9);
  EXPECT_THROW(delaunay(grid.topRows(5)), std::runtime_error);
}

TEST(Sampling, ALinearPictureIsWarpedExactly) {
  cv::Mat picture(60, 80, CV_32FC3);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) picture.at<cv::Vec3f>(y, x) = cv::Vec3f(x, y, 2 * x + y);
  Shape mean(4, 2), shape(4, 2);
  mean << -10, -10, 12, -9, 11, 10, -9, 12;
  shape << 20, 15, 45, 12, 47, 40, 18, 37;
  const auto triangles = delaunay(mean);
  const auto raster = make_raster(mean, triangles, 1);
  ASSERT_GT(raster.size(), 300);
  Pyramid pyramid(picture);
  Eigen::VectorXf texture;
  sample(pyramid, shape, triangles, raster, texture);
  const auto maps = affine_maps(raster.points, shape, triangles);
  for (Eigen::Index i = 0; i < raster.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto& m = maps[static_cast<std::size_t>(raster.triangle[at])];
    const float x = m.a * raster.x[at] + m.b * raster.y[at] + m.c, y = m.d * raster.x[at] + m.e * raster.y[at] + m.f;
    EXPECT_NEAR(texture(3 * i), x, 1e-3);
    EXPECT_NEAR(texture(3 * i + 1), y, 1e-3);
    EXPECT_NEAR(texture(3 * i + 2), 2 * x + y, 1e-3);
  }
}

TEST(Sampling, NormalisesToMeanZeroAndNormOne) {
  Eigen::VectorXf t(6);
  t << 1, 2, 3, 4, 5, 9;
  const Eigen::VectorXf before = t;
  const auto p = normalise(t);
  EXPECT_NEAR(p.offset, 4, 1e-6);
  EXPECT_NEAR(t.norm(), 1, 1e-6);
  EXPECT_LT((t.array() * float(p.gain) + float(p.offset) - before.array()).abs().maxCoeff(), 1e-5);
  Eigen::VectorXf flat = Eigen::VectorXf::Constant(6, 7);
  EXPECT_EQ(normalise(flat).gain, 0);
  EXPECT_EQ(flat.norm(), 0);
}

TEST(Pca, SmallAndLargeProblemAgreeAndReconstruct) {
  Random random(7);
  Eigen::MatrixXd tall(40, 8);
  for (Eigen::Index i = 0; i < tall.size(); ++i) tall(i) = random.normal() * (1 + i % 40);
  const auto small = pca(tall, 1);
  const Eigen::MatrixXd z = tall.colwise() - tall.rowwise().mean();
  EXPECT_EQ(small.variances.size(), 7);
  EXPECT_LT((small.modes.transpose() * small.modes - Eigen::MatrixXd::Identity(7, 7)).norm(), 1e-10);
  EXPECT_LT((small.modes * small.modes.transpose() * z - z).norm(), 1e-9);
  EXPECT_NEAR(small.total, z.squaredNorm() / 8, 1e-9);
  Eigen::MatrixXd wide(40, 16);
  wide << tall, tall;
  Eigen::MatrixXd wider(40, 48);
  wider << wide, wide, wide;
  const auto large = pca(wider, 1);
  ASSERT_EQ(large.variances.size(), 7);
  EXPECT_LT((large.variances - small.variances).norm(), 1e-8);
  EXPECT_LT((large.modes - small.modes).norm(), 1e-8);
}

TEST(Pca, KeepsTheShareAskedFor) {
  Random random(8);
  Eigen::MatrixXd m(5, 200);
  for (Eigen::Index i = 0; i < m.size(); ++i) m(i) = random.normal() * (i % 5 + 1);
  const auto kept = pca(m, 0.8);
  EXPECT_GE(kept.variances.sum(), 0.8 * kept.total);
  EXPECT_LT(kept.variances.head(kept.variances.size() - 1).sum(), 0.8 * kept.total);
}

TEST(Pca, EqualColumnsHaveNoModes) {
  EXPECT_EQ(pca(Eigen::MatrixXd::Ones(6, 3), 0.99).variances.size(), 0);
  EXPECT_EQ(pca(Eigen::MatrixXd::Random(6, 1), 0.99).variances.size(), 0);
}

}  // namespace
}  // namespace talkgraph
