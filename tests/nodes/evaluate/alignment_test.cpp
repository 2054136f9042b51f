#include "nodes/evaluate/alignment.h"

#include <gtest/gtest.h>

#include <cmath>

namespace talkgraph {
namespace {

using Row = std::vector<double>;

const PhoneTrack kTruth{{{"sil", 0, 0.1}, {"b", 0.1, 0.2}, {"iy", 0.2, 0.3}, {"t", 0.3, 0.4}, {"s", 0.4, 0.5}}};

/// Rounded to a millionth, for exact comparison.
Row rounded(Row row) {
  for (double& x : row) x = std::round(1e6 * x) / 1e6;
  return row;
}

Row row_of(const PhoneTrack& found) {
  return rounded(ScoreAlignment{}({{"a", kTruth}}, {{"a", found}}).table.cells[0]);
}

TEST(ScoreAlignment, ComparesStartsOfEqualPhones) {
  const PhoneTrack found{{{"b", 0.108, 0.2}, {"iy", 0.2, 0.285}, {"t", 0.285, 0.43}, {"s", 0.43, 0.5}}};
  const auto tables = ScoreAlignment{}({{"a", kTruth}}, {{"a", found}});
  EXPECT_EQ(tables.table.columns, (std::vector<std::string>{"phones", "different", "right time", "median", "bias",
                                                            "within 10 ms", "within 20 ms", "within 50 ms"}));
  // Errors: 8, 0, -15, 30 ms.
  EXPECT_EQ(rounded(tables.table.cells[0]), (Row{4, 0, 0.8675, 11.5, 4, 0.5, 0.75, 1}));
  EXPECT_EQ(tables.sequences.rows, std::vector<std::string>{"a"});
  EXPECT_EQ(tables.sequences.cells, tables.table.cells);
}

TEST(ScoreAlignment, LeavesOutWhatIsNotPaired) {
  // "iy" became "ih", "t" was not found, "ah" was put in, pauses do not matter.
  const PhoneTrack found{{{"b", 0.1, 0.2}, {"sil", 0.2, 0.21}, {"ih", 0.21, 0.3}, {"ah", 0.3, 0.4}, {"s", 0.4, 0.5}}};
  EXPECT_EQ(row_of(found), (Row{4, 0.5, 0.5, 0, 0, 1, 1, 1}));
  const PhoneTrack extra{{{"ah", 0, 0.1}, {"b", 0.1, 0.2}, {"iy", 0.2, 0.3}, {"t", 0.3, 0.4}, {"s", 0.4, 0.5}}};
  EXPECT_EQ(row_of(extra), (Row{4, 0.25, 1, 0, 0, 1, 1, 1}));
}

TEST(ScoreAlignment, PoolsAllPhonesOfAllSequences) {
  const PhoneTrack late{{{"s", 0.04, 0.2}}}, early{{{"s", 0.01, 0.2}}};
  const PhoneTrack truth{{{"s", 0.02, 0.2}}};
  const auto tables = ScoreAlignment{}({{"a", truth}, {"b", truth}, {"c", truth}}, {{"c", early}, {"a", late}});
  EXPECT_EQ(rounded(tables.table.cells[0]), (Row{3, 0.333333, 0.62963, 15, 5, 0.5, 1, 1}));
  EXPECT_EQ(tables.sequences.rows, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(rounded(tables.sequences.cells[0]), (Row{1, 0, 0.888889, 20, 20, 0, 1, 1}));
  EXPECT_EQ(tables.sequences.cells[1][1], 1) << "nothing was found";
  EXPECT_EQ(tables.sequences.cells[1][2], 0);
  EXPECT_TRUE(std::isnan(tables.sequences.cells[1][3]));
}

TEST(ScoreAlignment, OfNothing) {
  const auto none = ScoreAlignment{}({}, {}).table.cells[0];
  EXPECT_EQ(none[0], 0);
  EXPECT_TRUE(std::isnan(none[1]));
  const auto silent = ScoreAlignment{}({{"a", {{{"sil", 0, 1}}}}}, {{"a", kTruth}}).table.cells[0];
  EXPECT_TRUE(std::isnan(silent[1]) && std::isnan(silent[2]) && std::isnan(silent[3]));
  EXPECT_THROW(ScoreAlignment{}({}, {{"a", kTruth}}), std::invalid_argument);
}

}  // namespace
}  // namespace talkgraph
