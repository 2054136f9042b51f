#include "nodes/mapping/tied_gaussians.h"

#include <gtest/gtest.h>

#include "tests/nodes/latent/gaussian.h"

namespace talkgraph {
namespace {

using testing::gaussian;

/// Frames of contexts, `each` of every one, around means in one dimension.
FrameSums frames_around(const std::vector<double>& means, Eigen::Index each, double deviation) {
  FrameSums sums(std::ssize(means), 1);
  for (Eigen::Index k = 0; k < sums.counts.size(); ++k) {
    Eigen::VectorXd frames(each);
    for (Eigen::Index n = 0; n < each; ++n)
      frames(n) = means[static_cast<std::size_t>(k)] + (n % 2 == 0 ? deviation : -deviation);
    sums.add(k, frames, Eigen::VectorXd::Ones(each));
  }
  return sums;
}

TreeLimits limits(double penalty, double occupancy = 1) {
  return {true, occupancy, penalty, Eigen::VectorXd::Constant(1, 1e-6)};
}

Eigen::Index row(const TiedGaussians& tied, const PhoneContext& context) { return rows_of(tied, context, 1)[0]; }

TEST(PhoneRuns, KnowTheirNeighboursInTheirSequence) {
  const auto runs = phone_runs({"aa", "aa", "b", "b", "iy", "iy"}, {3, 3});
  ASSERT_EQ(runs.size(), 4U);
  const auto expect = [&](std::size_t i, const PhoneContext& context, Eigen::Index first, Eigen::Index frames) {
    EXPECT_EQ(runs[i].context, context) << i;
    EXPECT_EQ(runs[i].first, first);
    EXPECT_EQ(runs[i].frames, frames);
  };
  expect(0, {"", "aa", "b"}, 0, 2);
  expect(1, {"aa", "b", ""}, 2, 1);
  expect(2, {"", "b", "iy"}, 3, 1);
  expect(3, {"b", "iy", ""}, 4, 2);
  EXPECT_TRUE(phone_runs({}, {0}).empty());
}

TEST(TiedGaussians, AreSharedByPhonesOfAVisemeWhereTheseAreAlike) {
  // Before lips that close, aa is another than before the tongue.
  const std::vector<PhoneContext> contexts{{"", "aa", "b"}, {"", "aa", "p"}, {"", "aa", "s"},
                                           {"", "aa", "z"}, {"", "iy", "b"}, {"", "iy", "s"}};
  const TiedGaussians tied = grow_trees(contexts, {frames_around({0, 0, 3, 3, 9, 9}, 10, 0.5)}, limits(1));
  EXPECT_EQ(tied.means.rows(), 3);
  EXPECT_EQ(tied.means.cols(), 1);
  EXPECT_EQ(row(tied, contexts[0]), row(tied, contexts[1]));
  EXPECT_EQ(row(tied, contexts[2]), row(tied, contexts[3]));
  EXPECT_EQ(row(tied, contexts[4]), row(tied, contexts[5]));
  EXPECT_NE(row(tied, contexts[0]), row(tied, contexts[2]));
  EXPECT_NE(row(tied, contexts[0]), row(tied, contexts[4]));
  // Never met: m has the viseme of b and p; ae that of aa.
  EXPECT_EQ(row(tied, {"", "aa", "m"}), row(tied, contexts[0]));
  EXPECT_EQ(row(tied, {"k", "ae", "m"}), row(tied, contexts[0]));
}

TEST(TiedGaussians, SplitWhereTheGainExceedsTheDescriptionLength) {
  const std::vector<PhoneContext> contexts{{"", "aa", "b"}, {"", "aa", "s"}};
  const FrameSums sums = frames_around({0, 1}, 20, 0.5);
  // Variance 0.25 of each, 0.5 of both together; two Gaussians in place of one cost ln 40.
  const double gain = 0.5 * 40 * std::log(0.5 / 0.25), cost = std::log(40);
  EXPECT_EQ(grow_trees(contexts, {sums}, limits(0.999 * gain / cost)).means.rows(), 2);
  EXPECT_EQ(grow_trees(contexts, {sums}, limits(1.001 * gain / cost)).means.rows(), 1);
  EXPECT_EQ(grow_trees(contexts, {sums}, limits(1, 20)).means.rows(), 2);
  EXPECT_EQ(grow_trees(contexts, {sums}, limits(1, 21)).means.rows(), 1);
  TreeLimits alone = limits(1);
  alone.neighbours = false;
  EXPECT_EQ(grow_trees(contexts, {sums}, alone).means.rows(), 1);
}

TEST(TiedGaussians, HaveATreeAPosition) {
  const std::vector<PhoneContext> contexts{{"", "aa", ""}, {"", "b", ""}};
  const TiedGaussians tied =
      grow_trees(contexts, {frames_around({0, 5}, 9, 0.1), frames_around({2, 2}, 9, 0.1), FrameSums(2, 1)}, limits(1));
  EXPECT_EQ(tied.means.rows(), 4);
  const auto aa = rows_of(tied, contexts[0], 3), b = rows_of(tied, contexts[1], 3);
  EXPECT_NE(aa[0], b[0]);
  EXPECT_EQ(aa[1], b[1]);
  EXPECT_EQ(aa[2], b[2]);
  EXPECT_NE(aa[1], aa[2]);
}

TEST(TiedGaussians, AreMeansAndFlooredVariancesOfWhatTheyHave) {
  TiedGaussians tied{{}, Eigen::MatrixXd::Constant(2, 2, 7), Eigen::MatrixXd::Constant(2, 2, 8)};
  FrameSums sums(2, 2);
  sums.add(0, Eigen::MatrixXd{{1, 5}, {4, 5}}, Eigen::Vector2d(2, 1));
  maximise(tied, sums, Eigen::Vector2d(0.1, 0.3));
  EXPECT_TRUE(tied.means.row(0).isApprox(Eigen::RowVector2d(2, 5), 1e-12));
  EXPECT_TRUE(tied.variances.row(0).isApprox(Eigen::RowVector2d(2, 0.3), 1e-12));
  EXPECT_EQ(tied.means(1, 0), 7);
  EXPECT_EQ(tied.variances(1, 1), 8);
}

TEST(TiedGaussians, HaveTheDensitiesOfTextbooks) {
  const TiedGaussians tied{{}, gaussian(3, 4, 1), gaussian(3, 4, 2).cwiseAbs2().array() + 0.1};
  const Eigen::MatrixXd frames = gaussian(5, 4, 3);
  const Eigen::MatrixXd logs = log_densities(tied, {2, 0}, frames);
  for (Eigen::Index t = 0; t < 5; ++t)
    for (const auto& [column, row] : {std::pair(0, 2), std::pair(1, 0)})
      EXPECT_NEAR(logs(t, column),
                  testing::log_normal_density(frames.row(t), tied.means.row(row),
                                              Eigen::MatrixXd(tied.variances.row(row).asDiagonal())),
                  1e-10);
}

}  // namespace
}  // namespace talkgraph
