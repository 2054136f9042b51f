#include <gtest/gtest.h>

#include "nodes/speech/average.h"
#include "nodes/speech/deltas.h"
#include "nodes/speech/join.h"
#include "nodes/speech/one_hot.h"
#include "nodes/speech/stack.h"

namespace talkgraph {
namespace {

TEST(Join, PutsColumnsSideBySideOverTheCommonLength) {
  Track a, b;
  a.values = Eigen::MatrixXd::Ones(5, 2);
  b.values = Eigen::MatrixXd::Zero(4, 1);
  Eigen::MatrixXd expected(4, 3);
  expected << Eigen::MatrixXd::Ones(4, 2), Eigen::MatrixXd::Zero(4, 1);
  EXPECT_EQ(Join{}(a, &b).values, expected);
  b.values.resize(2, 1);
  EXPECT_THROW(Join{}(a, &b), std::runtime_error);
  b.values.resize(5, 1);
  b.rate = Rational(50);
  EXPECT_THROW(Join{}(a, &b), std::runtime_error);
  EXPECT_EQ(Join{}(a, nullptr).values, a.values);
}

TEST(Average, IsTheMeanOverTheDimensions) {
  Track a;
  a.values.resize(2, 3);
  a.values << 1, 2, 6, -1, 0, 1;
  a.start = 0.02;
  a.lost = {1};
  const Track mean = Average{"LSF"}(a);
  EXPECT_EQ(mean.values, Eigen::Vector2d(3, 0));
  EXPECT_EQ(mean.names, std::vector<std::string>{"LSF"});
  EXPECT_EQ(mean.start, 0.02);
  EXPECT_EQ(mean.lost, a.lost);
  a.values.resize(2, 0);
  EXPECT_THROW(Average{}(a), std::runtime_error);
}

TEST(Stack, RepeatsTheEnds) {
  Track a;
  a.values = Eigen::Vector3d(1, 2, 3);
  Eigen::MatrixXd expected(3, 3);
  expected << 1, 1, 2, 1, 2, 3, 2, 3, 3;
  EXPECT_EQ((Stack{1, 1}(a).values), expected);
  EXPECT_EQ((Stack{1, 1}(Track{}).frames()), 0);
}

TEST(Stack, NamesItsColumnsAndMarksRowsWithALostFrame) {
  Track t;
  t.values = Eigen::MatrixXd::Random(5, 1);
  t.names = {"c1"};
  t.lost = {1};
  const Track out = Stack{0, 1}(t);
  EXPECT_EQ(out.names, (std::vector<std::string>{"c1", "c1 at +1"}));
  EXPECT_EQ(out.lost, (std::vector<std::int64_t>{0, 1}));
}

TEST(Deltas, AreTheSlopeOfALine) {
  Track line;
  line.values.resize(10, 2);
  line.values.col(0) = Eigen::VectorXd::LinSpaced(10, 0, 27);
  line.values.col(1).setConstant(5);
  line.names = {"a", "b"};
  const Track d = Deltas{3}(line);
  for (int t = 3; t < 7; ++t) EXPECT_NEAR(d.values(t, 0), 3, 1e-12);
  EXPECT_TRUE(d.values.col(1).isZero());
  EXPECT_EQ(d.names[0], "delta a");
}

TEST(Deltas, FollowTheirFormulaAtTheEnds) {
  Track t;
  t.values.resize(4, 1);
  t.values << 1, 4, 9, 16;
  // Ends repeated: 1 1 | 1 4 9 16 | 16 16.
  const Eigen::Vector4d expected((1 * (4 - 1) + 2 * (9 - 1)) / 10.0, (1 * (9 - 1) + 2 * (16 - 1)) / 10.0,
                                 (1 * (16 - 4) + 2 * (16 - 1)) / 10.0, (1 * (16 - 9) + 2 * (16 - 4)) / 10.0);
  EXPECT_TRUE(Deltas{}(t).values.isApprox(expected, 1e-14));
  t.values.resize(1, 1);
  t.values << 7;
  EXPECT_EQ(Deltas{}(t).values(0, 0), 0);
  EXPECT_EQ(Deltas{}(Track{}).frames(), 0);
}

TEST(Deltas, OfDeltasAreTheCurvature) {
  Track parabola;
  parabola.values = Eigen::VectorXd::LinSpaced(20, 0, 19).cwiseAbs2();
  parabola.names = {"c1"};
  const Track twice = Deltas{}(Deltas{}(parabola));
  for (int t = 4; t < 16; ++t) EXPECT_NEAR(twice.values(t, 0), 2, 1e-12);
  EXPECT_EQ(twice.names[0], "delta delta c1");
}

TEST(OneHot, MarksTheLabelOfEachFrame) {
  const Track t = OneHot{{"sil", "aa", "b"}}(FrameLabels{{"aa", "sil", "aa"}, Rational(50)});
  Eigen::MatrixXd expected(3, 3);
  expected << 0, 1, 0, 1, 0, 0, 0, 1, 0;
  EXPECT_EQ(t.values, expected);
  EXPECT_DOUBLE_EQ(t.start, 0.01);
  EXPECT_EQ(t.names[2], "b");
  EXPECT_EQ((OneHot{{"sil", "aa", "b"}, 2.5}(FrameLabels{{"aa", "sil", "aa"}}).values), 2.5 * expected);
}

TEST(OneHot, KnowsTheCmuPhonesAndRefusesOthers) {
  EXPECT_EQ(cmu_phones().size(), 41u);
  EXPECT_EQ(OneHot{}(FrameLabels{{"zh", "sil", "breath"}}).values.sum(), 3);
  EXPECT_EQ(OneHot{}(FrameLabels{}).frames(), 0);
  try {
    OneHot{}(FrameLabels{{"aa", "AA1"}});
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("frame 1: label \"AA1\""), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace talkgraph
