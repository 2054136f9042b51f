#include "nodes/face/modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "nodes/face/build.h"
#include "synthetic_face.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using test::model;

/// The faces of one row, from minus two deviations to plus two.
struct Row {
  cv::Mat faces[5];
};

class Modes : public testing::Test {
 protected:
  Row first_row(FaceModes node, const IndependentComponents* components = nullptr) {
    context.folder = folder.path();
    node.modes = 1;
    const cv::Mat sheet = cv::imread((folder.path() / node(model(), components, context).path).string());
    Row row;
    const int width = (sheet.cols - 40) / 5;
    for (int i = 0; i < 5; ++i) row.faces[i] = sheet(cv::Rect(40 + i * width, 22, width, sheet.rows - 22));
    return row;
  }

  const test::TemporaryFolder folder;
  Context context;
};

double difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

/// Where the face is: not quite white.
cv::Mat outline(const cv::Mat& face) {
  cv::Mat out;
  cv::inRange(face, cv::Scalar::all(0), cv::Scalar::all(250), out);
  return out;
}

TEST_F(Modes, EveryKindHasTheSameMeanInTheMiddle) {
  FaceModes of_shape, of_texture;
  of_shape.of = ModeKind::shape;
  of_texture.of = ModeKind::texture;
  const Row combined = first_row({}), shape = first_row(of_shape), texture = first_row(of_texture);
  EXPECT_EQ(difference(combined.faces[2], shape.faces[2]), 0);
  EXPECT_EQ(difference(combined.faces[2], texture.faces[2]), 0);
  for (const Row* row : {&combined, &shape, &texture})
    for (const int side : {0, 1, 3, 4}) EXPECT_GT(difference(row->faces[side], row->faces[2]), 10);
}

TEST_F(Modes, OfTextureKeepTheShapeAndOfShapeDoNot) {
  FaceModes of_shape, of_texture;
  of_shape.of = ModeKind::shape;
  of_texture.of = ModeKind::texture;
  const Row shape = first_row(of_shape), texture = first_row(of_texture);
  EXPECT_EQ(cv::countNonZero(outline(texture.faces[0]) != outline(texture.faces[4])), 0);
  EXPECT_GT(cv::countNonZero(outline(shape.faces[0]) != outline(shape.faces[4])), 100);
}

TEST_F(Modes, ComponentsThatAreTheModesLookLikeThem) {
  const Eigen::VectorXd deviations = model().combined_variances.cwiseSqrt();
  IndependentComponents c{Eigen::RowVectorXd::Zero(model().modes()), deviations.asDiagonal(),
                          deviations.cwiseInverse().asDiagonal()};
  const Row modes = first_row({}), same = first_row({}, &c);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(difference(modes.faces[i], same.faces[i]), 0);
  c.mixing.col(0) *= -1;
  const Row turned = first_row({}, &c);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(difference(modes.faces[i], turned.faces[4 - i]), 0);
}

TEST_F(Modes, RefuseComponentsThatDoNotFit) {
  IndependentComponents other{Eigen::RowVectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1),
                              Eigen::MatrixXd::Identity(1, 1)};
  EXPECT_THROW(first_row({}, &other), std::runtime_error);
  FaceModes of_shape;
  of_shape.of = ModeKind::shape;
  other.mixing = Eigen::MatrixXd::Identity(model().modes(), 1);
  EXPECT_THROW(first_row(of_shape, &other), std::runtime_error);
}

TEST_F(Modes, AModelWithoutModesShowsItsMean) {
  auto p = test::synthetic_prototypes();
  p.images.resize(1);
  p.shapes.resize(1);
  context.folder = folder.path();
  for (const auto kind : {ModeKind::combined, ModeKind::shape, ModeKind::texture}) {
    FaceModes node;
    node.of = kind;
    const auto picture = node(BuildAppearance{}(p, context), nullptr, context);
    EXPECT_FALSE(cv::imread((folder.path() / picture.path).string()).empty());
  }
}

}  // namespace
}  // namespace talkgraph
