#include "nodes/face/build.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "nodes/face/geometry.h"
#include "nodes/face/sampling.h"
#include "synthetic_face.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

AppearanceModel build(const Prototypes& p) {
  Context context;
  return BuildAppearance{}(p, context);
}

Key hash(AppearanceModel m) {
  return content_key([&](Archive& ar) { fields(ar, m); });
}

TEST(BuildAppearance, ReconstructsPrototypesWithinTheVarianceKept) {
  const auto prototypes = test::synthetic_prototypes();
  const auto m = build(prototypes);
  double lost = 0, total = 0;
  for (std::size_t i = 0; i < prototypes.shapes.size(); ++i) {
    Pyramid picture(prototypes.images[i].pixels);
    Eigen::VectorXf texture;
    sample(picture, prototypes.shapes[i], m.triangles, m.levels[0].raster, texture);
    normalise(texture);
    const Eigen::VectorXd centred = (texture - m.levels[0].mean->col(0)).cast<double>();
    const Eigen::VectorXd b = m.texture_modes->cast<double>().transpose() * centred;
    lost += (centred - m.texture_modes->cast<double>() * b).squaredNorm();
    total += centred.squaredNorm();
  }
  EXPECT_LT(lost / total, 0.0101);
  EXPECT_LT(m.residual, 2);
}

TEST(BuildAppearance, WeighsShapeAgainstTextureByAllTheirVariance) {
  const auto p = test::synthetic_prototypes();
  Context context;
  const auto all = BuildAppearance{.retain_shape = 1, .retain_texture = 1}(p, context);
  const auto m = BuildAppearance{.retain_shape = 0.6, .retain_texture = 0.9}(p, context);
  EXPECT_NEAR(all.shape_weight * all.shape_weight, all.texture_variances.sum() / all.shape_variances.sum(), 1e-9);
  EXPECT_NEAR(m.shape_weight, all.shape_weight, 1e-9 * all.shape_weight);
  EXPECT_EQ(m.combined_modes.rows(), m.shape_variances.size() + m.texture_variances.size());
  const double weighed = std::pow(m.shape_weight, 2) * m.shape_variances.sum() + m.texture_variances.sum();
  EXPECT_GE(m.combined_variances.sum(), 0.99 * weighed * (1 - 1e-9));
}

TEST(BuildAppearance, NeverEnlarges) {
  const auto m = build(test::synthetic_prototypes());
  const double width = m.mean_shape.col(0).maxCoeff() - m.mean_shape.col(0).minCoeff();
  EXPECT_LT(width, 91);
  EXPECT_GT(width, 89);
  EXPECT_NEAR(m.picture_scale, 1, 0.01);
}

TEST(BuildAppearance, IsTheSameEachTime) {
  const auto p = test::synthetic_prototypes();
  EXPECT_EQ(hash(build(p)), hash(build(p)));
}

TEST(BuildAppearance, SurvivesSavingAndLoading) {
  auto m = build(test::synthetic_prototypes());
  const test::TemporaryFolder folder;
  const auto path = folder.file("face.h5");
  write_hdf5(path, [&](Archive& ar) { fields(ar, m); });
  AppearanceModel loaded;
  fields(*hdf5_reader(path), loaded);
  EXPECT_EQ(hash(loaded), hash(m));
}

TEST(BuildAppearance, TakesTheTrianglesOfTheScheme) {
  auto prototypes = test::synthetic_prototypes();
  std::string mean;
  for (Eigen::Index i = 0; i < prototypes.shapes[0].rows(); ++i)
    mean += fmt::format("{}[{}, {}]", i ? ", " : "", prototypes.shapes[0](i, 0), prototypes.shapes[0](i, 1));
  prototypes.scheme = fmt::format(R"({{"name": "star", "triangles": [[0, 5, 11], [5, 8, 11]], "mean": [{}]}})", mean);
  Context context;
  EXPECT_EQ(BuildAppearance{}(prototypes, context).triangles, (Triangles(2, 3) << 0, 5, 11, 5, 8, 11).finished());
  for (auto& shape : prototypes.shapes) shape.conservativeResize(20, 2);
  EXPECT_THROW(BuildAppearance{}(prototypes, context), std::runtime_error) << "the scheme has more points";
}

TEST(BuildAppearance, GivesTexturesRoomBetweenTheLips) {
  auto prototypes = test::synthetic_prototypes();
  const auto plain = build(prototypes);
  std::string mean;
  for (Eigen::Index i = 0; i < prototypes.shapes[0].rows(); ++i)
    mean += fmt::format("{}[{}, {}]", i ? ", " : "", prototypes.shapes[0](i, 0), prototypes.shapes[0](i, 1));
  prototypes.scheme =
      fmt::format(R"({{"name": "lips", "names": {{"inner_top": 34, "inner_bottom": 30}}, "mean": [{}]}})", mean);
  const auto roomy = build(prototypes);
  const auto gap = [](const Shape& points) { return points(30, 1) - points(34, 1); };
  EXPECT_EQ(roomy.mean_shape, plain.mean_shape);
  EXPECT_NEAR(gap(plain.levels[0].raster.points), gap(plain.mean_shape), 1e-9);
  EXPECT_GT(gap(roomy.levels[0].raster.points), 1.3 * gap(plain.levels[0].raster.points));
  for (const auto& level : roomy.levels)
    EXPECT_NEAR(gap(level.raster.points), level.raster.scale * gap(roomy.levels[0].raster.points), 1e-9);
}

TEST(BuildAppearance, OnePrototypeGivesARigidModel) {
  auto p = test::synthetic_prototypes();
  p.images.resize(1);
  p.shapes.resize(1);
  const auto m = build(p);
  EXPECT_EQ(m.modes(), 0);
  EXPECT_TRUE(m.shape(Eigen::VectorXd(0)).isApprox(m.mean_shape));
}

TEST(BuildAppearance, RefusesWhatIsNoPrototype) {
  EXPECT_THROW(build({}), std::runtime_error);
  auto p = test::synthetic_prototypes();
  p.shapes[3](2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(build(p), std::runtime_error);
  p = test::synthetic_prototypes();
  p.shapes[2].conservativeResize(10, 2);
  EXPECT_THROW(build(p), std::runtime_error);
  p = test::synthetic_prototypes();
  p.images[1].pixels.setTo(cv::Scalar::all(77));
  EXPECT_THROW(build(p), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
