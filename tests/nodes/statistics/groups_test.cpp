#include "nodes/statistics/groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "nodes/statistics/proportions.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

Table scores(const std::vector<double>& acc) {
  Table t{"", "sequence", {"acc"}, {}, {}};
  for (const double value : acc) {
    t.rows.emplace_back(1, static_cast<char>('a' + t.rows.size()));
    t.cells.push_back({value});
  }
  return t;
}

TEST(CompareGroups, TestsEveryPairOfAnySizes) {
  const Table t = CompareGroups{}({{"A", scores({4, 5, 6})}, {"B", scores({1, 2, 3})}, {"C", scores({7, 8, 9, 10})}});
  EXPECT_EQ(t.rows, (std::vector<std::string>{"A - B", "A - C", "B - C"}));
  EXPECT_EQ(t.columns, (std::vector<std::string>{"acc", "acc p", "acc effect"}));
  // Of C(6, 3) = 20 and C(7, 3) = 35 choices one is as extreme at either end; Holm: 2/35 counts thrice, then the
  // larger.
  const std::vector<std::vector<double>> expected = {{3, 6 / 35.0, 1}, {-3.5, 6 / 35.0, -1}, {-6.5, 6 / 35.0, -1}};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(t.cells[r][c], expected[r][c], 1e-12) << r << ", " << c;
  const Table plain =
      CompareGroups{.correction = Correction::none}({{"A", scores({4, 5, 6})}, {"B", scores({1, 2, 3})}});
  EXPECT_NEAR(plain.cells[0][1], 0.1, 1e-12);
}

TEST(CompareGroups, LeavesOutWhatIsMissing) {
  const Table t = CompareGroups{}({{"A", scores({1, NAN, 2})}, {"B", scores({NAN})}, {"C", scores({3, 4})}});
  EXPECT_TRUE(std::isnan(t.cells[0][1])) << "nothing to test";
  EXPECT_NEAR(t.cells[1][0], -2, 1e-12);
  EXPECT_NEAR(t.cells[1][1], 2 / 6.0, 1e-12);
  EXPECT_TRUE(CompareGroups{}({}).rows.empty());
}

TEST(CompareGroups, RefusesWhatDoesNotFit) {
  EXPECT_THROW(CompareGroups{.scores = {"amse"}}({{"A", scores({1})}}), std::runtime_error);
  EXPECT_THROW(CompareGroups{}({{"A", scores({INFINITY})}, {"B", scores({1})}}), std::runtime_error);
}

Table counts() { return {"", "clips", {"right", "shown"}, {"real", "synthetic", "none"}, {{7, 16}, {3, 12}, {0, 0}}}; }

std::string refusal(const Proportions& node, const Table& table) {
  try {
    node(table);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(Proportions, HaveIntervalsAndEffects) {
  const Table t = Proportions{"right", "shown", "real", 0.99}(counts());
  EXPECT_EQ(t.columns, (std::vector<std::string>{"share", "share low", "share high", "h"}));
  EXPECT_EQ(t.rows, counts().rows);
  EXPECT_EQ(t.corner, "clips");
  EXPECT_EQ(t.cells[0][0], 7 / 16.0);
  EXPECT_NEAR(t.cells[0][1], 0.18661357439928483, 1e-10);
  EXPECT_EQ(t.cells[0][3], 0);
  EXPECT_NEAR(t.cells[1][3], cohens_h(0.25, 7 / 16.0), 1e-12);
  for (const double v : t.cells[2]) EXPECT_TRUE(std::isnan(v)) << "of nothing";
  EXPECT_EQ((Proportions{"right", "shown"}(counts()).columns.size()), 3u);
}

TEST(Proportions, RefusesWhatIsNoCount) {
  EXPECT_THAT(refusal({"wrong", "shown"}, counts()), HasSubstr("no column \"wrong\"; it has right, shown"));
  EXPECT_THAT(refusal({"right", "shown", "fake"}, counts()), HasSubstr("no row \"fake\""));
  for (const double bad : {0.5, -1.0, double{NAN}, double{INFINITY}}) {
    Table t = counts();
    t.cells[1][0] = bad;
    EXPECT_THAT(refusal({"right", "shown"}, t), HasSubstr("right of \"synthetic\" is")) << bad;
  }
  EXPECT_THAT(refusal({"shown", "right"}, counts()), HasSubstr("\"real\" has 16 shown of 7 right"));
}

}  // namespace
}  // namespace talkgraph
