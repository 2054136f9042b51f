#include "nodes/statistics/methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "nodes/statistics/register.h"

namespace talkgraph {
namespace {

/// Scores of sequences a, b, ...: acc, and twice as much error.
Table scores(const std::vector<double>& acc) {
  Table t{"", "sequence", {"acc", "error"}, {}, {}};
  for (const double value : acc) {
    t.rows.emplace_back(1, static_cast<char>('a' + t.rows.size()));
    t.cells.push_back({value, 2 * value});
  }
  return t;
}

double cell(const Table& t, const std::string& row, const std::string& column) {
  const auto r = std::find(t.rows.begin(), t.rows.end(), row) - t.rows.begin();
  const auto c = std::find(t.columns.begin(), t.columns.end(), column) - t.columns.begin();
  return t.cells.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
}

const Collected<Table> kMethods = {{"recorded", scores({1, 1, 1, 1, 1, 1})},
                                   {"mean", scores({0, 0, 0, 0, 0, 0})},
                                   {"ridge", scores({0.4, 0.5, 0.6, 0.5, 0.3, 0.2})},
                                   {"SSGPDM", scores({0.6, 0.75, 0.55, 0.7, 0.8, 0.4})}};

CompareMethods::Out compare(const CompareMethods& node, const Collected<Table>& methods = kMethods) {
  Random random(1);
  return node(methods, random);
}

TEST(CompareMethods, DescribesAndTestsEachMethod) {
  const Table t = compare({.against = "SSGPDM", .aside = {"recorded"}}).table;
  EXPECT_EQ(t.rows, kMethods.keys());
  EXPECT_EQ(t.columns, (std::vector<std::string>{"acc", "acc std", "acc low", "acc high", "acc p", "error", "error std",
                                                 "error low", "error high", "error p", "sequences"}));
  const auto interval = student_interval({0.4, 0.5, 0.6, 0.5, 0.3, 0.2}, 0.95);
  EXPECT_NEAR(cell(t, "ridge", "acc"), 2.5 / 6, 1e-12);
  EXPECT_NEAR(cell(t, "ridge", "error"), 5 / 6.0, 1e-12);
  EXPECT_NEAR(cell(t, "ridge", "acc low"), interval.low, 1e-12);
  EXPECT_NEAR(cell(t, "ridge", "acc high"), interval.high, 1e-12);
  EXPECT_EQ(cell(t, "ridge", "sequences"), 6);
  // mean: 6 of 6 below, p = 2/64; ridge: 5 of 6, the one above smallest, p = 4/64. Holm: times 2, times 1.
  EXPECT_NEAR(cell(t, "mean", "acc p"), 4 / 64.0, 1e-12);
  EXPECT_NEAR(cell(t, "ridge", "acc p"), 4 / 64.0, 1e-12);
  EXPECT_TRUE(std::isnan(cell(t, "SSGPDM", "acc p")));
  EXPECT_TRUE(std::isnan(cell(t, "recorded", "acc p")));
}

TEST(CompareMethods, ComparesEveryPair) {
  const Table t = compare({.scores = {"acc"}, .aside = {"recorded"}, .correction = Correction::none}).pairs;
  EXPECT_EQ(t.rows, (std::vector<std::string>{"mean - ridge", "mean - SSGPDM", "ridge - SSGPDM"}));
  EXPECT_EQ(t.columns, (std::vector<std::string>{"acc", "acc p", "acc effect"}));
  EXPECT_NEAR(cell(t, "mean - ridge", "acc"), -2.5 / 6, 1e-12);
  EXPECT_NEAR(cell(t, "mean - ridge", "acc p"), 2 / 64.0, 1e-12);
  EXPECT_EQ(cell(t, "mean - ridge", "acc effect"), -1);
  EXPECT_NEAR(cell(t, "ridge - SSGPDM", "acc p"), 4 / 64.0, 1e-12);
  EXPECT_NEAR(cell(t, "ridge - SSGPDM", "acc effect"), -19 / 21.0, 1e-12);
}

TEST(CompareMethods, TellsEachSequence) {
  const Table t =
      compare({.scores = {"error"}, .aside = {"recorded"}, .larger_better = {"acc"}, .smaller_better = {"error"}})
          .sequences;
  EXPECT_EQ(t.corner, "sequence");
  EXPECT_EQ(t.rows, (std::vector<std::string>{"a", "b", "c", "d", "e", "f"}));
  EXPECT_EQ(t.columns,
            (std::vector<std::string>{"acc", "acc: SSGPDM", "acc: ridge", "acc: mean", "acc: recorded", "error",
                                      "error: mean", "error: ridge", "error: SSGPDM", "error: recorded"}));
  EXPECT_EQ(t.cells[1], (std::vector<double>{0.75, 0.75, 0.5, 0, 1, 0, 0, 1, 1.5, 2}));
  EXPECT_EQ(cell(t, "c", "acc"), 0.6) << "of ridge";
}

TEST(CompareMethods, TestsTheBestAgainstAllOthers) {
  const auto out = compare({.aside = {"recorded"}, .larger_better = {"acc"}, .smaller_better = {"error"}});
  const Table& t = out.best;
  EXPECT_EQ(t.rows, (std::vector<std::string>{"SSGPDM", "ridge", "mean"}));
  EXPECT_EQ(t.columns, (std::vector<std::string>{"acc behind", "acc behind p", "acc won", "error behind",
                                                 "error behind p", "error won"}));
  EXPECT_EQ(cell(t, "SSGPDM", "acc behind"), 0);
  EXPECT_TRUE(std::isnan(cell(t, "SSGPDM", "acc behind p")));
  EXPECT_NEAR(cell(t, "mean", "acc behind"), 3.8 / 6, 1e-12);
  EXPECT_NEAR(cell(t, "ridge", "acc behind"), 1.3 / 6, 1e-12);
  // Three pairs: p = 2/64 twice, 4/64. Holm: times 3, times 2 or as much, times 1 or as much.
  EXPECT_NEAR(cell(t, "mean", "acc behind p"), 6 / 64.0, 1e-12);
  EXPECT_NEAR(cell(t, "ridge", "acc behind p"), 6 / 64.0, 1e-12);
  EXPECT_EQ(cell(t, "ridge", "acc behind p"), cell(out.pairs, "ridge - SSGPDM", "acc p"));
  EXPECT_EQ(cell(t, "SSGPDM", "acc won"), 5);
  EXPECT_EQ(cell(t, "ridge", "acc won"), 1);
  EXPECT_EQ(cell(t, "mean", "acc won"), 0);
  // By the least error the mean is best, and ridge is before the SSGPDM.
  EXPECT_EQ(cell(t, "mean", "error behind"), 0);
  EXPECT_NEAR(cell(t, "ridge", "error behind"), 5 / 6.0, 1e-12);
  EXPECT_NEAR(cell(t, "SSGPDM", "error behind"), 7.6 / 6, 1e-12);
  EXPECT_EQ(cell(t, "mean", "error won"), 6);
}

TEST(CompareMethods, RanksMethodsOfDifferentSequences) {
  Table few = scores({0.9, 0.95, 0.6});
  few.rows = {"b", "g", "a"};
  few.cells[1][0] = NAN;  // g has no acc of any method
  const auto out = compare({.larger_better = {"acc"}}, {{"few", few}, {"ridge", kMethods[2]}, {"SSGPDM", kMethods[3]}});
  EXPECT_EQ(out.sequences.rows, (std::vector<std::string>{"b", "g", "a", "c", "d", "e", "f"}));
  EXPECT_TRUE(std::isnan(cell(out.sequences, "g", "acc: few")));
  EXPECT_TRUE(std::isnan(cell(out.sequences, "g", "acc"))) << "that nobody has";
  EXPECT_TRUE(std::isnan(cell(out.sequences, "c", "acc: few")));
  EXPECT_EQ(cell(out.sequences, "c", "acc: ridge"), 0.6);
  EXPECT_EQ(cell(out.best, "few", "acc behind"), 0) << "of mean 0.75";
  EXPECT_NEAR(cell(out.best, "SSGPDM", "acc behind"), (0 + 0.15) / 2, 1e-12);
  EXPECT_EQ(cell(out.best, "few", "acc won"), 2) << "one of them with the SSGPDM";
  EXPECT_EQ(cell(out.best, "SSGPDM", "acc won"), 4);
  EXPECT_EQ(cell(out.best, "ridge", "acc won"), 1);
}

TEST(CompareMethods, RanksBySequencesThatAllHave) {
  const Table easy = scores({0.8});
  const auto out =
      compare({.larger_better = {"acc"}}, {{"easy", easy}, {"all", scores({0.9, 0.2})}, {"none", scores({})}});
  EXPECT_EQ(out.best.rows, (std::vector<std::string>{"all", "easy", "none"}));
  EXPECT_EQ(cell(out.best, "all", "acc behind"), 0);
  EXPECT_NEAR(cell(out.best, "easy", "acc behind"), 0.1, 1e-12);
  EXPECT_TRUE(std::isnan(cell(out.best, "none", "acc behind")));
  EXPECT_EQ(out.sequences.columns, (std::vector<std::string>{"acc", "acc: all", "acc: easy", "acc: none"}));

  Table other = easy;
  other.rows = {"z"};
  const auto apart = compare({.larger_better = {"acc"}}, {{"easy", easy}, {"other", other}});
  EXPECT_TRUE(std::isnan(cell(apart.best, "easy", "acc behind"))) << "nothing is shared";
  EXPECT_TRUE(std::isnan(cell(apart.best, "other", "acc behind")));
}

TEST(CompareMethods, RanksOneMethodAndOneSequence) {
  const auto alone = compare({.larger_better = {"acc"}}, {{"ridge", kMethods[2]}});
  EXPECT_EQ(alone.best.rows, (std::vector<std::string>{"ridge"}));
  EXPECT_EQ(cell(alone.best, "ridge", "acc behind"), 0);
  EXPECT_TRUE(std::isnan(cell(alone.best, "ridge", "acc behind p")));
  EXPECT_EQ(cell(alone.best, "ridge", "acc won"), 6);

  const auto one = compare({.larger_better = {"acc"}}, {{"a", scores({0.5})}, {"b", scores({0.25})}});
  EXPECT_EQ(one.sequences.cells, (std::vector<std::vector<double>>{{0.5, 0.5, 0.25}}));
  EXPECT_EQ(cell(one.best, "b", "acc behind"), 0.25);
  EXPECT_EQ(cell(one.best, "b", "acc behind p"), 1);

  const auto aside = compare({.aside = {"a"}, .larger_better = {"acc"}}, {{"a", scores({0.5})}});
  EXPECT_TRUE(aside.best.rows.empty());
  EXPECT_EQ(aside.sequences.rows.size(), 1u);
}

// A face of full range correlates as the one that it is made of, but for rounding.
TEST(CompareMethods, TakesWhatRoundingLeavesForEqual) {
  const std::vector<double> acc = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  std::vector<double> above = acc;
  for (double& value : above) value *= 1 + 1e-15;
  const auto out = compare({.against = "a", .larger_better = {"acc"}}, {{"a", scores(acc)}, {"b", scores(above)}});
  EXPECT_EQ(cell(out.table, "b", "acc p"), 1);
  EXPECT_EQ(cell(out.pairs, "a - b", "acc"), 0);
  EXPECT_EQ(cell(out.pairs, "a - b", "acc effect"), 0);
  EXPECT_EQ(cell(out.best, "a", "acc behind"), 0);
  EXPECT_FALSE(std::signbit(cell(out.best, "a", "acc behind")));
  EXPECT_EQ(cell(out.best, "a", "acc won"), 6);
  EXPECT_EQ(cell(out.best, "b", "acc won"), 6);
}

TEST(CompareMethods, RanksByNothingUnlessTold) {
  const auto out = compare({.against = "SSGPDM"});
  EXPECT_TRUE(out.sequences.columns.empty());
  EXPECT_TRUE(out.best.columns.empty());
}

TEST(CompareMethods, PairsSequencesByTheirNamesAndLeavesOutWhatIsMissing) {
  Table few = scores({0.1, 0.2, 0.3, 0.4});
  few.rows = {"f", "e", "d", "a"};
  few.cells[0][0] = NAN;
  const auto out = compare({.scores = {"acc"}, .against = "SSGPDM"}, {{"few", few}, {"SSGPDM", kMethods[3]}});
  EXPECT_NEAR(cell(out.table, "few", "acc"), 0.3, 1e-12);
  EXPECT_EQ(cell(out.table, "few", "sequences"), 4);
  EXPECT_NEAR(cell(out.pairs, "few - SSGPDM", "acc"), ((0.2 - 0.8) + (0.3 - 0.7) + (0.4 - 0.6)) / 3, 1e-12);
  EXPECT_NEAR(cell(out.table, "few", "acc p"), 2 / 8.0, 1e-12);
}

TEST(CompareMethods, WithoutAnythingToCompare) {
  const auto none = compare({}, {});
  EXPECT_TRUE(none.table.rows.empty());
  EXPECT_TRUE(none.pairs.rows.empty());
  EXPECT_TRUE(none.sequences.rows.empty());
  const auto empty = compare({.against = "a", .larger_better = {"acc"}}, {{"a", scores({})}, {"b", scores({})}});
  EXPECT_TRUE(std::isnan(cell(empty.table, "b", "acc p")));
  EXPECT_TRUE(std::isnan(cell(empty.table, "b", "acc")));
  EXPECT_TRUE(std::isnan(cell(empty.pairs, "a - b", "acc effect")));
  EXPECT_TRUE(std::isnan(cell(empty.best, "a", "acc behind"))) << "there is no best one";
  EXPECT_TRUE(std::isnan(cell(empty.best, "b", "acc behind p")));
  EXPECT_EQ(cell(empty.best, "a", "acc won"), 0);
}

TEST(CompareMethods, BootstrapsIntervals) {
  const Table t = compare({.interval = IntervalKind::bootstrap}).table;
  EXPECT_GT(cell(t, "ridge", "acc low"), 0.2);
  EXPECT_LT(cell(t, "ridge", "acc low"), cell(t, "ridge", "acc"));
  EXPECT_LT(cell(t, "ridge", "acc high"), 0.6);
  EXPECT_EQ(std::count(t.columns.begin(), t.columns.end(), "acc p"), 0) << "nothing to test against";
}

TEST(CompareMethods, RefusesWhatDoesNotFit) {
  EXPECT_THROW(compare({.against = "HMM"}), std::runtime_error);
  EXPECT_THROW(compare({.aside = {"HMM"}}), std::runtime_error);
  EXPECT_THROW(compare({.scores = {"amse"}}), std::runtime_error);
  EXPECT_THROW(compare({.larger_better = {"amse"}}), std::runtime_error);
  EXPECT_THROW(compare({.larger_better = {"acc"}, .smaller_better = {"acc"}}), std::runtime_error);
  EXPECT_THROW(compare({.smaller_better = {"error", "error"}}), std::runtime_error);
  Table other = scores({1});
  other.columns[1] = "amse";
  EXPECT_THROW(compare({}, {{"a", scores({1})}, {"b", other}}), std::runtime_error);
  Table twice = scores({1, 2});
  twice.rows[1] = "a";
  EXPECT_THROW(compare({}, {{"a", twice}}), std::runtime_error);
  EXPECT_THROW(compare({}, {{"a", scores({INFINITY})}}), std::runtime_error);
}

TEST(RegisterStatistics, DescribesEveryNode) {
  Registry registry;
  register_statistics(registry);
  for (const char* name : {"statistics.groups", "statistics.methods", "statistics.proportions"})
    EXPECT_TRUE(registry.find(name)) << name;
}

}  // namespace
}  // namespace talkgraph
