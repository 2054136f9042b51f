#include "nodes/types/centred.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace talkgraph {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Centred, HasMeanAndDeviationOfWhatIsThere) {
  Eigen::MatrixXd frames(4, 2);
  frames << 1, nan, 2, 5, 3, 7, 6, nan;
  const CentredFrames c = centred(frames);
  EXPECT_TRUE(c.mean.isApprox(Eigen::RowVector2d(3, 6)));
  EXPECT_TRUE(c.deviation.isApprox(Eigen::RowVector2d(std::sqrt(3.5), 1)));
  EXPECT_TRUE(c.values.col(1).isApprox(Eigen::Vector4d(0, -1, 1, 0)));
  EXPECT_TRUE(c.varies());
}

TEST(Centred, TellsVariationFromRoundingInAnyUnits) {
  Eigen::MatrixXd frames = Eigen::MatrixXd::Constant(20000, 4, 0.1);
  frames.col(1).array() += 1e-15 * Eigen::ArrayXd::LinSpaced(20000, -1, 1);
  frames.col(2).array() += 1e-12 * Eigen::ArrayXd::LinSpaced(20000, -1, 1);
  frames.col(3).setLinSpaced(20000, 0, 1);
  for (const double unit : {1e-200, 1e-13, 1.0, 1e13, 1e200}) {
    const CentredFrames c = centred(unit * frames);
    EXPECT_EQ(c.deviation[0], 0);
    EXPECT_EQ(c.deviation[1], 0);
    EXPECT_TRUE(c.values.leftCols(2).isZero(0));
    EXPECT_NEAR(c.deviation[2] / unit, 1e-12 / std::sqrt(3), 1e-15);
    EXPECT_NEAR(c.deviation[3] / unit, 1 / std::sqrt(12), 1e-4);
    EXPECT_FALSE(centred(unit * frames.leftCols(2)).varies());
  }
}

}  // namespace
}  // namespace talkgraph
