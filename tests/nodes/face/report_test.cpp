#include "nodes/face/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "nodes/face/build.h"
#include "nodes/face/prototype_sheet.h"
#include "nodes/face/reconstruct.h"
#include "synthetic_face.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

AppearanceModel build(const Prototypes& p, double retain) {
  Context context;
  BuildAppearance node;
  node.retain_shape = node.retain_texture = node.retain_combined = retain;
  return node(p, context);
}

FaceReport::Out report(const AppearanceModel& m, const Prototypes& training, const Prototypes& unseen) {
  Context context;
  return FaceReport{}(m, training, unseen, context);
}

/// Mouths between those of the prototypes.
Prototypes unseen() {
  Prototypes p;
  p.scheme = "synthetic";
  for (int t = 0; t < 12; ++t) {
    p.images.push_back({test::draw(test::talking_face(t))});
    p.shapes.push_back(test::landmarks(test::talking_face(t)));
  }
  return p;
}

TEST(FaceReport, AModelThatKeepsAllGivesItsPrototypesBack) {
  const auto p = test::synthetic_prototypes();
  const auto out = report(build(p, 1), p, unseen());
  for (const auto& stage : out.stages.cells) EXPECT_NEAR(stage[1], 1, 1e-3);
  EXPECT_EQ(out.errors.cells[0][0], 16);
  EXPECT_LT(out.errors.cells[0][1], 0.02);
  EXPECT_LT(out.errors.cells[0][2], 0.01);
  EXPECT_GT(out.errors.cells[1][1], 2 * out.errors.cells[0][1]);
  EXPECT_GT(out.errors.cells[1][2], 10 * out.errors.cells[0][2]);
}

TEST(FaceReport, SharesAreOfTheVarianceThatThereIs) {
  const auto p = test::synthetic_prototypes();
  const auto m = build(p, 0.9);
  const auto out = report(m, p, unseen());
  const auto all = build(p, 1);
  EXPECT_NEAR(out.stages.cells[0][1], m.shape_variances.sum() / all.shape_variances.sum(), 2e-3);
  EXPECT_NEAR(out.stages.cells[1][1], m.texture_variances.sum() / all.texture_variances.sum(), 1e-4);
  for (const auto& stage : out.stages.cells) EXPECT_GE(stage[1], 0.9 - 1e-6);
  EXPECT_EQ(out.stages.cells[2][0], static_cast<double>(m.modes()));
  const auto& modes = out.modes.cells;
  EXPECT_EQ(modes.size(), static_cast<std::size_t>(std::max(
                              {m.shape_variances.size(), m.texture_variances.size(), m.combined_variances.size()})));
  double sum = 0;
  for (std::size_t k = 0; k < modes.size() && !std::isnan(modes[k][4]); ++k) {
    sum += modes[k][4];
    EXPECT_NEAR(modes[k][5], sum, 1e-9);
  }
  EXPECT_NEAR(sum, out.stages.cells[2][1], 1e-9);
}

TEST(FaceReport, MoreModesShowUnseenPicturesBetter) {
  const auto p = test::synthetic_prototypes();
  const auto few = report(build(p, 0.7), p, unseen()).errors, many = report(build(p, 0.999), p, unseen()).errors;
  EXPECT_LT(many.cells[1][1], few.cells[1][1]);
  EXPECT_LT(many.cells[1][2], few.cells[1][2]);
  EXPECT_GT(many.cells[1][3], few.cells[1][3] + 1);
  for (const auto& row : many.cells) {
    EXPECT_GE(row[4], row[1]);
    EXPECT_GE(row[5], row[2]);
    EXPECT_LE(row[6], row[3]);
  }
}

TEST(FaceReport, ARigidModelKeepsNothing) {
  auto p = test::synthetic_prototypes();
  p.images.resize(1);
  p.shapes.resize(1);
  const auto out = report(build(p, 1), p, unseen());
  for (const auto& stage : out.stages.cells) {
    EXPECT_EQ(stage[0], 0);
    EXPECT_FALSE(stage[1] > 0);
  }
  EXPECT_TRUE(out.modes.rows.empty());
  EXPECT_GT(out.errors.cells[1][1], 1);
}

TEST(FaceReport, RefusesWhatDoesNotFit) {
  const auto p = test::synthetic_prototypes();
  const auto m = build(p, 0.9);
  EXPECT_THROW(report(m, p, {}), std::runtime_error);
  auto other = unseen();
  other.shapes[3].conservativeResize(5, 2);
  EXPECT_THROW(report(m, p, other), std::runtime_error);
  other = unseen();
  other.shapes[3](2, 0) = NAN;
  EXPECT_THROW(report(m, p, other), std::runtime_error);
}

TEST(Reconstruct, DrawsTheFaceWhereItWas) {
  const auto p = test::synthetic_prototypes();
  const auto m = build(p, 1);
  const auto picture = test::draw(test::talking_face(3));
  const auto r = reconstruct(m, picture, test::landmarks(test::talking_face(3)));
  EXPECT_LT(test::rms_distance(r.shape, test::landmarks(test::talking_face(3))), 0.5);
  EXPECT_NEAR(r.landmarks, test::rms_distance(r.shape, test::landmarks(test::talking_face(3))), 1e-9);
  EXPECT_GT(r.psnr, 25);
  EXPECT_EQ(cv::norm(r.picture(cv::Rect(0, 0, 200, 20)), picture(cv::Rect(0, 0, 200, 20))), 0);
  EXPECT_GT(cv::norm(r.picture, picture), 0);
}

TEST(Sheets, ShowPrototypes) {
  const test::TemporaryFolder folder;
  Context context;
  context.folder = folder.path();
  const auto p = test::synthetic_prototypes();
  const auto sheet = cv::imread((folder.path() / PrototypeSheet{}(p, context).path).string());
  EXPECT_EQ(sheet.cols, 12 * 120);
  const auto rows = cv::imread((folder.path() / ModelSheet{}(build(p, 0.99), p, context).path).string());
  EXPECT_EQ(rows.cols, 4 * 240);
  const int height = rows.rows / 3;
  const auto tile = [&](int i) { return rows(cv::Rect(240 * i, 0, 240, height)); };
  for (int i = 1; i < 4; ++i) EXPECT_GT(cv::norm(tile(0), tile(i), cv::NORM_INF), 20);
  EXPECT_LT(cv::norm(tile(0), tile(3), cv::NORM_L1), cv::norm(tile(0), tile(2), cv::NORM_L1));
  EXPECT_THROW(PrototypeSheet{}({}, context), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
