#include "nodes/normalise/ica.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "nodes/normalise/restore.h"
#include "nodes/normalise/style.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  return t;
}

/// Independent, each of another kind: even, peaked, a swing, rare events; mean 0.
Eigen::MatrixXd sources(Eigen::Index frames) {
  Random random(3);
  Eigen::MatrixXd s(frames, 4);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double sign = random.uniform() < 0.5 ? -1 : 1;
    s.row(t) << random.uniform(-1.7, 1.7), sign * std::log(1 - random.uniform()), std::sin(0.37 * double(t)),
        random.uniform() < 0.1 ? 3 * random.normal() : 0.1 * random.normal();
  }
  return s.rowwise() - s.colwise().mean();
}

const Eigen::MatrixXd& mixing() {
  static const Eigen::MatrixXd a =
      (Eigen::MatrixXd(4, 4) << 3, 1, 0.5, -1, 0.2, -2, 1, 0.4, -1, 0.3, 1.5, 0.8, 0.6, 1, -0.4, 2).finished();
  return a;
}

Collected<Track> mixture(Eigen::Index frames = 4000) {
  const Eigen::MatrixXd x = (sources(frames) * mixing().transpose()).rowwise() + Eigen::RowVector4d(10, -3, 0, 1);
  return {{"a", track(x.topRows(frames / 3))}, {"b", track(x.bottomRows(frames - frames / 3))}};
}

LearnIca::Out learn(const LearnIca& node, const Collected<Track>& tracks, std::uint64_t seed = 1,
                    std::string* warning = nullptr) {
  Random random(seed);
  Context context;
  if (warning) context.on_warning = [=](std::string_view text) { *warning = text; };
  return node(tracks, random, context);
}

std::string complaint(const Collected<Track>& tracks) {
  try {
    learn({}, tracks);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "nothing";
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return x.dot(y) / (x.norm() * y.norm());
}

class Variants : public testing::TestWithParam<std::tuple<Decorrelation, Contrast, double>> {
 protected:
  static LearnIca node() {
    LearnIca n;
    std::tie(n.decorrelation, n.contrast, n.a1) = GetParam();
    return n;
  }
};

TEST_P(Variants, RecoverTheSourcesUpToOrderSignAndScale) {
  const auto truth = sources(4000);
  const auto all = mixture();
  const auto out = learn(node(), all);
  Eigen::MatrixXd x(4000, 4);
  x << all[0].values, all[1].values;
  const Eigen::MatrixXd u = out.components.of(x);
  for (Eigen::Index s = 0; s < 4; ++s) {
    double best = 0, rest = 0;
    for (Eigen::Index k = 0; k < 4; ++k) {
      const double r = std::abs(correlation(truth.col(s), u.col(k)));
      rest = std::max(rest, std::min(best, r));
      best = std::max(best, r);
    }
    EXPECT_GT(best, 0.995) << s;
    EXPECT_LT(rest, 0.1) << s;
  }
  for (const auto& row : out.convergence.cells) EXPECT_LT(row[3], node().tolerance);
}

TEST_P(Variants, GiveWhiteComponentsThatAddUpToTheRows) {
  const auto all = mixture();
  const auto c = learn(node(), all).components;
  Eigen::MatrixXd x(4000, 4);
  x << all[0].values, all[1].values;
  const Eigen::MatrixXd u = c.of(x);
  EXPECT_LT(u.colwise().mean().cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((u.transpose() * u / 4000 - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((c.unmixing * c.mixing - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_TRUE(((u * c.mixing.transpose()).rowwise() + c.mean).isApprox(x, 1e-12));
}

INSTANTIATE_TEST_SUITE_P(Ica, Variants,
                         testing::Values(std::tuple{Decorrelation::symmetric, Contrast::logcosh, 1.0},
                                         std::tuple{Decorrelation::symmetric, Contrast::logcosh, 2.0},
                                         std::tuple{Decorrelation::symmetric, Contrast::gauss, 1.0},
                                         std::tuple{Decorrelation::deflation, Contrast::logcosh, 1.0},
                                         std::tuple{Decorrelation::deflation, Contrast::gauss, 1.0}));

// The fixed point of Eqn A.15's update: E[x g(wᵀx)] is parallel to w once settled, within what decorrelation leaves.
TEST(Ica, TheFirstDeflatedDirectionIsAFixedPointOfThePrintedUpdate) {
  const auto all = mixture();
  const Eigen::MatrixXd x = all[1].values.rowwise() - all[1].values.colwise().mean();
  const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd(x.transpose() * x / double(x.rows())));
  const Eigen::MatrixXd white = factor.matrixL().solve(x.transpose());
  Random random(1);
  const auto found = FastIca{Decorrelation::deflation}(white, random);
  const Eigen::VectorXd w = found.directions.row(0);
  Eigen::VectorXd next = Eigen::VectorXd::Zero(4);
  double slope = 0;
  for (Eigen::Index n = 0; n < white.cols(); ++n) {
    const double g = std::tanh(w.dot(white.col(n)));
    next += g * white.col(n);
    slope += 1 - g * g;
  }
  next = next / double(white.cols()) - slope / double(white.cols()) * w;
  EXPECT_NEAR(std::abs(next.normalized().dot(w)), 1, 1e-6);
}

TEST(Ica, ComesInTheOrderOfVarianceWithSignsFixed) {
  const auto c = learn({}, mixture()).components;
  for (Eigen::Index k = 1; k < 4; ++k) EXPECT_GE(c.mixing.col(k - 1).norm(), c.mixing.col(k).norm());
  for (Eigen::Index k = 0; k < 4; ++k) EXPECT_EQ(c.mixing.col(k).maxCoeff(), c.mixing.col(k).cwiseAbs().maxCoeff());
  EXPECT_EQ(c.mixing, learn({}, mixture()).components.mixing);
  EXPECT_TRUE(c.mixing.isApprox(learn({}, mixture(), 7).components.mixing, 1e-2)) << "another start, the same sources";
}

TEST(Ica, LeavesOutLostFramesAndWhatDoesNotVary) {
  auto all = mixture();
  Eigen::MatrixXd wide(all[0].frames(), 5);
  wide << all[0].values, Eigen::VectorXd::Constant(all[0].frames(), 7);
  Track good = track(wide), bad = track(wide);
  bad.values.row(5).setConstant(NAN);
  bad.lost = {5};
  const auto c = learn({}, {{"a", good}, {"b", bad}}).components;
  EXPECT_EQ(c.count(), 4);
  EXPECT_EQ(c.dimension(), 5);
  RemoveStyle all_style;
  all_style.style = {1, 2, 3, 4};
  const auto out = all_style(c, good, nullptr);
  EXPECT_LT(out.normalised.values.cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(out.style.values(0, 4), 7, 1e-9);
}

TEST(Ica, KeepsTheLargestDirectionsIfToldTo) {
  LearnIca two;
  two.components = 2;
  const auto out = learn(two, mixture());
  EXPECT_EQ(out.components.count(), 2);
  EXPECT_LT((out.components.unmixing * out.components.mixing - Eigen::Matrix2d::Identity()).cwiseAbs().maxCoeff(),
            1e-10);
  EXPECT_GT(out.convergence.cells[0][0] + out.convergence.cells[1][0], 0.6);
}

TEST(Ica, WarnsOfWhatHasNotSettled) {
  LearnIca hasty;
  hasty.iterations = 1;
  std::string warning;
  learn(hasty, mixture(), 1, &warning);
  EXPECT_THAT(warning, HasSubstr("independent components have not settled after 1 iterations"));
  warning.clear();
  learn({}, mixture(), 1, &warning);
  EXPECT_EQ(warning, "");
}

TEST(Ica, SaysWhatIsWrongWithTheTracks) {
  EXPECT_THAT(complaint({}), HasSubstr("no tracks to learn from"));
  EXPECT_THAT(complaint({{"a", track(Eigen::MatrixXd::Random(3, 4))}}), HasSubstr("3 frames are too few"));
  EXPECT_THAT(complaint({{"a", track(Eigen::MatrixXd::Constant(9, 4, 2))}}), HasSubstr("do not vary"));
  EXPECT_THAT(complaint({{"a", track(Eigen::MatrixXd::Zero(9, 4))}}), HasSubstr("do not vary"));
  EXPECT_EQ(complaint({{"a", track(Eigen::MatrixXd::Random(9, 4))}, {"b", track(Eigen::MatrixXd::Random(9, 3))}}),
            "b: 3 dimensions, a has 4");
  Eigen::MatrixXd nan = Eigen::MatrixXd::Random(9, 4);
  nan(6, 1) = NAN;
  EXPECT_EQ(complaint({{"a", track(nan)}}), "a: a value of frame 6 is not finite");
}

TEST(RemoveStyle, TakesOffTheNamedComponentsAndRestorePutsThemBack) {
  const auto all = mixture();
  const auto c = learn({}, all).components;
  RemoveStyle node;
  node.style = {2, 4};
  const auto out = node(c, all[0], nullptr);
  Eigen::MatrixXd u = c.of(all[0].values);
  u.col(1).setZero();
  u.col(3).setZero();
  EXPECT_TRUE(out.normalised.values.isApprox(u * c.mixing.transpose(), 1e-10));
  EXPECT_TRUE(Restore{}(out.normalised, out.style).values.isApprox(all[0].values, 1e-14));
  const auto none = RemoveStyle{}(c, all[0], nullptr);
  EXPECT_TRUE(none.normalised.values.isApprox(Eigen::MatrixXd(all[0].values.rowwise() - c.mean), 1e-10));
}

TEST(RemoveStyle, TakesWhatTheRankingCallsStyle) {
  const auto all = mixture();
  const auto c = learn({}, all).components;
  const Table ranking{
      "", "component", {"variance", "style"}, {"3", "1", "2", "4"}, {{0, 1}, {0, 0.9}, {0, 0.85}, {0, 0}}};
  RemoveStyle named;
  named.style = {1, 3};
  EXPECT_EQ(RemoveStyle{}(c, all[0], &ranking).normalised.values, named(c, all[0], nullptr).normalised.values);
  EXPECT_EQ(named(c, all[0], &ranking).normalised.values, named(c, all[0], nullptr).normalised.values);
}

TEST(RemoveStyle, RefusesWhatDoesNotFit) {
  const auto all = mixture();
  const auto c = learn({}, all).components;
  RemoveStyle node;
  node.style = {5};
  EXPECT_THROW(node(c, all[0], nullptr), std::runtime_error);
  node.style = {0};
  EXPECT_THROW(node(c, all[0], nullptr), std::runtime_error);
  EXPECT_THROW(RemoveStyle{}(c, track(Eigen::MatrixXd::Zero(2, 3)), nullptr), std::runtime_error);
  EXPECT_THROW(RemoveStyle{}(c, track(Eigen::MatrixXd::Constant(2, 4, NAN)), nullptr), std::runtime_error);
  const Table other{"", "", {"style"}, {"1"}, {{1}}};
  EXPECT_THROW(RemoveStyle{}(c, all[0], &other), std::runtime_error);
  EXPECT_EQ(RemoveStyle{}(c, track(Eigen::MatrixXd::Zero(0, 4)), nullptr).normalised.frames(), 0);
}

}  // namespace
}  // namespace talkgraph
