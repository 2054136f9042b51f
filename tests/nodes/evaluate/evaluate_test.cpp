#include <gtest/gtest.h>

#include <cmath>

#include "graph/random.h"
#include "nodes/evaluate/columns.h"
#include "nodes/evaluate/compare.h"
#include "nodes/evaluate/curves.h"
#include "nodes/evaluate/dimensions.h"
#include "nodes/evaluate/join.h"
#include "nodes/evaluate/mouth_lag.h"
#include "nodes/evaluate/mouth_opening.h"
#include "nodes/evaluate/score.h"
#include "nodes/evaluate/seams.h"
#include "nodes/evaluate/sequences.h"
#include "nodes/evaluate/summary.h"

namespace talkgraph {
namespace {

Track track(Eigen::MatrixXd values) {
  Track t;
  t.values = std::move(values);
  return t;
}

TEST(Score, AgreesWithValuesByHand) {
  Eigen::MatrixXd z(3, 2), p(3, 2);
  z << 1, 1, 2, 0, 3, -1;
  p << 2, 1, 4, 1, 6, 1;
  auto s = Score{}(track(z), track(p), nullptr)->values;
  EXPECT_DOUBLE_EQ(s["amse"], (1 + 4 + 9 + 0 + 1 + 4) / 6.0);
  EXPECT_DOUBLE_EQ(s["amse_share"], s["amse"] / (16 / 6.0));
  EXPECT_DOUBLE_EQ(s["acc"], 0.5);  // 1 for the first, 0 for the second, which does not vary
  EXPECT_DOUBLE_EQ(s["l1"], 9 / 6.0);
  EXPECT_DOUBLE_EQ(s["l2"], std::sqrt(s["amse"]));
  EXPECT_DOUBLE_EQ(s["linf"], (1 + 2 + 3) / 3.0);
  EXPECT_DOUBLE_EQ(s["range"], 2);
}

TEST(Score, OfTheMeanHasShareOne) {
  const Eigen::MatrixXd z = Eigen::MatrixXd::Random(20, 4);
  auto s = Score{}(track(z), track(Eigen::MatrixXd::Zero(20, 4)), nullptr)->values;
  EXPECT_DOUBLE_EQ(s["amse_share"], 1);
  EXPECT_EQ(s["acc"], 0);
  s = Score{}(track(z), track(z), nullptr)->values;
  EXPECT_NEAR(s["acc"], 1, 1e-12);
  EXPECT_EQ(s["amse"], 0);
}

TEST(Score, DoesNotDependOnTheUnit) {
  const Eigen::MatrixXd z = Eigen::MatrixXd::Random(20, 3), p = Eigen::MatrixXd::Random(20, 3);
  auto large = Score{}(track(z), track(p), nullptr)->values;
  auto small = Score{}(track(1e-9 * z), track(1e-9 * p), nullptr)->values;
  for (const char* name : {"acc", "amse_share", "range"}) EXPECT_NEAR(small[name], large[name], 1e-9) << name;
}

TEST(Score, OfAConstantTruthHasNoShareOrRange) {
  const Eigen::MatrixXd p = Eigen::MatrixXd::Random(10, 2);
  auto s = Score{}(track(Eigen::MatrixXd::Zero(10, 2)), track(p), nullptr)->values;
  EXPECT_TRUE(std::isnan(s["amse_share"]));
  EXPECT_TRUE(std::isnan(s["range"]));
  s = Score{}(track(Eigen::MatrixXd::Constant(10, 2, 0.1)), track(p), nullptr)->values;
  EXPECT_EQ(s["acc"], 0);
  EXPECT_TRUE(std::isnan(s["range"]));
}

TEST(Score, CountsSpeechFramesOnly) {
  Eigen::MatrixXd z(4, 1), p(4, 1);
  z << 1, 2, 3, 100;
  p << 1, 2, 4, 0;
  const Mask speech{{1, 1, 1, 0}}, silence{{0, 0, 0, 0}};
  EXPECT_DOUBLE_EQ(Score{}(track(z), track(p), &speech)->values["amse"], 1 / 3.0);
  EXPECT_FALSE(Score{}(track(z), track(p), &silence));
}

TEST(Score, LeavesLostFramesOfTheTruthOut) {
  Track truth, predicted;
  truth.values = Eigen::Vector3d(1, 500, -1);
  predicted.values = Eigen::Vector3d(1, 0, -1);
  truth.lost = {1};
  EXPECT_EQ(Score{}(truth, predicted, nullptr)->values.at("amse"), 0);
  truth.lost = {0, 1, 2};
  EXPECT_FALSE(Score{}(truth, predicted, nullptr));
}

TEST(Score, RefusesWhatDoesNotFit) {
  const auto zeros = [](int r, int c) { return track(Eigen::MatrixXd::Zero(r, c)); };
  EXPECT_NO_THROW(Score{}(zeros(10, 2), zeros(12, 2), nullptr));
  EXPECT_THROW(Score{}(zeros(10, 2), zeros(13, 2), nullptr), std::runtime_error);
  EXPECT_THROW(Score{}(zeros(10, 2), zeros(10, 3), nullptr), std::runtime_error);
  const Mask near{std::vector<std::int64_t>(8, 1)}, far{std::vector<std::int64_t>(7, 1)};
  EXPECT_NO_THROW(Score{}(zeros(10, 2), zeros(10, 2), &near));
  EXPECT_THROW(Score{}(zeros(10, 2), zeros(10, 2), &far), std::runtime_error);
  Track broken = zeros(10, 2);
  broken.values(3, 1) = NAN;
  EXPECT_THROW(Score{}(zeros(10, 2), broken, nullptr), std::runtime_error);
}

TEST(Summary, GivesMeanAndSampleDeviation) {
  const Table t = Summary{{"acc"}}({{"a", {{{"acc", 1}}}}, {"b", {{{"acc", 3}}}}, {"c", {{{"acc", NAN}}}}});
  EXPECT_EQ(t.columns, (std::vector<std::string>{"acc", "acc std", "sequences"}));
  EXPECT_EQ(t.cells[0][0], 2);
  EXPECT_DOUBLE_EQ(t.cells[0][1], std::sqrt(2.0));
  EXPECT_EQ(t.cells[0][2], 3);
  EXPECT_TRUE(std::isnan(Summary{}({}).cells[0][0]));
}

TEST(SequenceTable, HasARowASequence) {
  const Table t = SequenceTable{.scores = {"b", "a"}}({{"x", {{{"a", 1}, {"b", 2}}}}, {"y", {{{"a", 3}}}}});
  EXPECT_EQ(t.rows, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(t.cells[0], (std::vector<double>{2, 1}));
  EXPECT_TRUE(std::isnan(t.cells[1][0]));
  EXPECT_TRUE(SequenceTable{}({}).rows.empty());
}

TEST(TakeCurves, AveragesOverParametersOrTakesOne) {
  Track a, b;
  a.values = Eigen::MatrixXd{{1, 3}, {5, 9}};
  a.names = {"left", "right"};
  b.values = Eigen::MatrixXd{{2, 0}};
  const Curves mean = TakeCurves{}({{"a", a}, {"b", b}});
  EXPECT_EQ(mean.keys, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(mean.curves[0].values, (Eigen::MatrixXd{{2}, {7}}));
  EXPECT_TRUE(mean.curves[0].names.empty());
  EXPECT_EQ(TakeCurves{1}({{"a", a}}).curves[0].values, (Eigen::MatrixXd{{3}, {9}}));
  EXPECT_TRUE(TakeCurves{}({}).keys.empty());
  EXPECT_THROW(TakeCurves{2}({{"a", a}}), std::runtime_error);
  EXPECT_THROW(TakeCurves{}({{"none", Track{}}}), std::runtime_error);
}

TEST(Compare, StacksRowsUnderTheirNames) {
  Table a = Summary{{"acc"}}({{"x", {{{"acc", 1}}}}}), b = Summary{{"acc"}}({{"x", {{{"acc", 2}}}}});
  const Table t = Compare{}({{"ridge", a}, {"SSGPDM", b}});
  EXPECT_EQ(t.rows, (std::vector<std::string>{"ridge", "SSGPDM"}));
  EXPECT_EQ(t.cells[1][0], 2);
  b.columns[0] = "other";
  EXPECT_THROW(Compare{}({{"ridge", a}, {"SSGPDM", b}}), std::runtime_error);
}

TEST(PickColumns, TakesWhatBelongsToThem) {
  const Table table{
      "all", "method", {"acc", "acc std", "acc p", "accuracy", "lve", "sequences"}, {"a"}, {{1, 2, 3, 4, 5, 6}}};
  const Table t = PickColumns{{"lve", "acc"}, "some"}(table);
  EXPECT_EQ(t.title, "some");
  EXPECT_EQ(t.columns, (std::vector<std::string>{"lve", "acc", "acc std", "acc p"}));
  EXPECT_EQ(t.cells[0], (std::vector<double>{5, 1, 2, 3}));
  EXPECT_EQ(PickColumns{}(table).title, "all");
  EXPECT_THROW((PickColumns{{"amse"}, ""}(table)), std::runtime_error);
}

TEST(JoinScores, TakesAllThatAreThere) {
  const Scores a{{{"acc", 1}}}, b{{{"lve", 2}}};
  EXPECT_EQ(JoinScores{}(a, nullptr, &b, nullptr, nullptr, nullptr, nullptr).values,
            (std::map<std::string, double>{{"acc", 1}, {"lve", 2}}));
  EXPECT_THROW(JoinScores{}(a, &b, &a, nullptr, nullptr, nullptr, nullptr), std::runtime_error);
}

TEST(ScoreDimensions, ScoresEachByItselfAndAveragesOverSequences) {
  Eigen::MatrixXd z(4, 2), p(4, 2);
  z << 1, 1, 2, 0, 3, -1, 50, 50;
  p << 2, 1, 4, 1, 6, 1, 0, 0;
  const Mask speech{{1, 1, 1, 0}};
  const Collected<Track> truth = {{"a", track(z)}, {"b", track(z)}, {"c", track(z)}, {"d", track(z)}};
  const Collected<Track> said = {{"b", track(z)}, {"a", track(p)}, {"c", track(p)}};
  const Table t = ScoreDimensions{}(truth, said, {{"a", speech}, {"b", speech}, {"c", {{0, 0, 0, 0}}}});
  EXPECT_EQ(t.rows, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(t.columns, (std::vector<std::string>{"acc", "acc std", "l1", "l1 std", "l2", "l2 std", "mse", "mse std",
                                                 "linf", "linf std", "range", "range std", "sequences"}));
  const auto cell = [&](std::size_t row, std::size_t column) { return t.cells[row][column]; };
  EXPECT_NEAR(cell(0, 0), 1, 1e-12);
  EXPECT_NEAR(cell(1, 0), 0.5, 1e-12) << "0 of a sequence whose prediction does not vary";
  EXPECT_NEAR(cell(0, 2), (1 + 2 + 3) / 3.0 / 2, 1e-12);
  EXPECT_NEAR(cell(0, 4), std::sqrt(14 / 3.0) / 2, 1e-12);
  EXPECT_NEAR(cell(0, 6), 14 / 3.0 / 2, 1e-12);
  EXPECT_NEAR(cell(0, 8), 3 / 2.0, 1e-12);
  EXPECT_NEAR(cell(0, 10), (2 + 1) / 2.0, 1e-12);
  EXPECT_EQ(cell(0, 12), 2);
  EXPECT_TRUE(ScoreDimensions{}({}, {}, {}).rows.empty());
  EXPECT_THROW(ScoreDimensions{}(truth, {{"a", track(p.leftCols(1))}}, {{"a", speech}}), std::runtime_error);
  EXPECT_THROW(ScoreDimensions{}({{"a", track(z)}, {"b", track(z.leftCols(1))}},
                                 {{"a", track(z)}, {"b", track(z.leftCols(1))}}, {{"a", speech}, {"b", speech}}),
               std::runtime_error);
}

// A mouth that opens with the loudness of the sound, `late` frames later.
Scores lag_of(int late, bool all_found = true) {
  Random random(2);
  std::vector<double> loudness(100);
  for (std::size_t t = 0; t < loudness.size(); ++t)
    loudness[t] = t ? 0.6 * loudness[t - 1] + 0.4 * random.uniform() : 0.5;
  Audio audio;
  audio.rate = 1000;
  audio.samples.resize(4000);
  for (Eigen::Index i = 0; i < 4000; ++i)
    audio.samples[i] = std::pow(10, 2 * loudness[static_cast<std::size_t>(i / 40)] - 3) * (i % 2 ? 1 : -1);
  LandmarkTrack landmarks;
  for (int t = 0; t < 100; ++t) {
    Shape shape = Shape::Zero(68, 2);
    shape(66, 1) = 10 * loudness[static_cast<std::size_t>(std::clamp(t - late, 0, 99))];
    if (!all_found && t % 7 == 3) shape.setConstant(NAN);
    landmarks.frames.push_back(shape);
  }
  return *MouthLag{}(landmarks, audio);
}

TEST(MouthLag, FindsHowLateTheMouthIs) {
  for (const int late : {-3, 0, 2}) {
    auto s = lag_of(late).values;
    EXPECT_EQ(s["lag"], late);
    EXPECT_GT(s["correlation"], 0.99);
  }
}

TEST(MouthLag, LeavesOutFramesWithoutLandmarks) {
  auto s = lag_of(2, false).values;
  EXPECT_EQ(s["lag"], 2);
  EXPECT_GT(s["correlation"], 0.99);
}

TEST(MouthLag, SaysNothingOfAStillMouthAndRefusesOtherSchemes) {
  Audio audio;
  audio.samples = Eigen::VectorXd::Random(16000);
  LandmarkTrack still;
  still.frames.assign(25, Shape::Zero(68, 2));
  EXPECT_FALSE(MouthLag{}(still, audio));
  still.frames.resize(1);
  EXPECT_FALSE(MouthLag{}(still, audio));
  still.frames.assign(25, Shape::Zero(20, 2));
  EXPECT_THROW(MouthLag{}(still, audio), std::runtime_error);
}

/// A mouth 4 wide whose inner lips are gaps[t] apart.
LandmarkTrack mouth(const std::vector<double>& gaps) {
  LandmarkTrack landmarks;
  for (const double gap : gaps) {
    Shape shape = Shape::Zero(68, 2);
    shape(66, 1) = gap;
    shape(54, 0) = 4;
    landmarks.frames.push_back(shape);
  }
  return landmarks;
}

TEST(MouthOpening, TellsClosedFromOpenPhones) {
  const FrameLabels labels{{"sil", "sil", "b", "b", "aa", "aa", "m", "s"}, Rational(25)};
  const auto scores = *MouthOpening{}(mouth({0.2, 0.6, 0.8, 0.4, 2, 3, 0, 1}), labels);
  EXPECT_NEAR(scores.values.at("pause"), 0.1, 1e-12);
  EXPECT_NEAR(scores.values.at("closed"), 0.05, 1e-12) << "0.4 of b, 0 of m";
  EXPECT_NEAR(scores.values.at("open"), 0.75, 1e-12);
  const auto other = *MouthOpening{.closed = {"s"}, .open = {}}(mouth({1, 2}), {{"s", "s"}, Rational(25)});
  EXPECT_EQ(other.values, (std::map<std::string, double>{{"closed", 0.25}}));
}

TEST(MouthOpening, TakesThePointsOfTheScheme) {
  LandmarkTrack landmarks{{Shape::Zero(56, 2)}, Rational(25), "face56"};
  landmarks.frames[0](54, 1) = 1;  // the middle of the inner lower lip
  landmarks.frames[0](42, 0) = 4;  // a corner
  EXPECT_DOUBLE_EQ(MouthOpening{}(landmarks, {{"b"}, Rational(25)})->values.at("closed"), 0.25);
}

TEST(MouthOpening, LeavesOutFramesWithoutLandmarks) {
  auto some = mouth({0.2, 9, 0.8, 0.4, 0.1, 9});
  const FrameLabels labels{{"sil", "sil", "b", "b", "m", "m"}, Rational(25)};
  for (const std::size_t t : {1, 4, 5}) some.frames[t].setConstant(NAN);
  const auto scores = *MouthOpening{}(some, labels);
  EXPECT_NEAR(scores.values.at("pause"), 0.05, 1e-12);
  EXPECT_NEAR(scores.values.at("closed"), 0.1, 1e-12) << "of b alone";
  for (auto& shape : some.frames) shape.setConstant(NAN);
  EXPECT_FALSE(MouthOpening{}(some, labels));
}

TEST(MouthOpening, SaysNothingWithoutItsPhonesAndRefusesWhatDoesNotFit) {
  EXPECT_FALSE(MouthOpening{}({}, {}));
  EXPECT_FALSE(MouthOpening{}(mouth({1}), {{"s"}, Rational(25)}));
  EXPECT_TRUE(MouthOpening{}(mouth({1, 1, 1}), {{"b"}, Rational(25)}));
  EXPECT_THROW(MouthOpening{}(mouth({1, 1, 1, 1}), {{"b"}, Rational(25)}), std::runtime_error);
  LandmarkTrack other;
  other.frames = {Shape::Zero(20, 2)};
  EXPECT_THROW(MouthOpening{}(other, {{"b"}, Rational(25)}), std::runtime_error);
  other.frames = {Shape::Zero(68, 2)};
  EXPECT_THROW(MouthOpening{}(other, {{"b"}, Rational(25)}), std::runtime_error);
}

TEST(Seams, ComparesStepsAtSeamsWithOthers) {
  const SegmentTrack segments{{{"a", 0, 3}, {"b", 3, 2}}, 5, Rational(25)};
  Track track;
  track.values = Eigen::VectorXd::LinSpaced(5, 0, 4);
  EXPECT_NEAR(Seams{}(track, segments)->values.at("step"), 1, 1e-12);
  track.values.bottomRows(2).array() += 5;
  EXPECT_NEAR(Seams{}(track, segments)->values.at("step"), 6, 1e-12);
  track.values << 0, 0, 0, 2, 3;
  const SegmentTrack pause{{{"lead_sil", 0, 3}, {"b", 3, 2}}, 5, Rational(25)};
  EXPECT_NEAR(Seams{}(track, pause)->values.at("step"), 2, 1e-12) << "a still pause is no measure";
}

TEST(Seams, SaysNothingWithoutSeamsAndRefusesOtherLengths) {
  Track track;
  track.values = Eigen::VectorXd::LinSpaced(5, 0, 4);
  EXPECT_FALSE(Seams{}(track, {{{"a", 0, 5}}, 5, Rational(25)}));
  EXPECT_FALSE(Seams{}({}, {}));
  EXPECT_TRUE(Seams{}(track, {{{"a", 0, 3}, {"b", 3, 4}}, 7, Rational(25)}));
  EXPECT_THROW(Seams{}(track, {{{"a", 0, 8}}, 8, Rational(25)}), std::runtime_error);
  track.values.setConstant(1);
  EXPECT_FALSE(Seams{}(track, {{{"a", 0, 3}, {"b", 3, 2}}, 5, Rational(25)}));
}

}  // namespace
}  // namespace talkgraph
