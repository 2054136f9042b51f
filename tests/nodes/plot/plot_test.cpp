#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "nodes/plot/axis.h"
#include "nodes/plot/bars.h"
#include "nodes/plot/columns.h"
#include "nodes/plot/mean_trajectory.h"
#include "nodes/plot/phone_averages.h"
#include "nodes/plot/phone_means.h"
#include "nodes/plot/svg.h"
#include "nodes/plot/tracks.h"
#include "nodes/plot/trajectories.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;
using testing::Not;

Track constant(int frames, double value) {
  Track t;
  t.values = Eigen::MatrixXd::Constant(frames, 2, value);
  return t;
}

TEST(Svg, DrawsLinesThroughTheirPoints) {
  const std::string svg = draw_panels("t & u", {{"t", "x", "y", {{"s", {0, 1}, {0, 1}}}}}, {1, 268, 170});
  EXPECT_THAT(svg, HasSubstr("M0.0 100.0L200.0 0.0"));
  EXPECT_THAT(svg, HasSubstr("<title>t &amp; u</title>"));
}

TEST(Svg, SurvivesNothingConstantsAndNaN) {
  EXPECT_THAT(draw_panels("", {}), HasSubstr("</svg>"));
  const std::string svg = draw_panels("", {{"t", "", "", {{"s", {0, 1, 2}, {NAN, 5, 5}}, {"empty", {}, {}}}}});
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Svg, LetsANaNInterruptALine) {
  const std::string svg = draw_panels("", {{"", "", "", {{"s", {0, 1, 2, 3, 4}, {0, 1, NAN, 1, 0}}}}}, {1, 268, 170});
  EXPECT_THAT(svg, HasSubstr("M0.0 100.0L50.0 0.0M150.0 0.0L200.0 100.0"));
}

TEST(Axis, HasRoundLimitsAndTicks) {
  const Axis a = axis_over(-0.13, 0.55, 4);
  EXPECT_NEAR(a.low, -0.2, 1e-12);
  EXPECT_NEAR(a.high, 0.6, 1e-12);
  ASSERT_EQ(a.ticks().size(), 5u);
  EXPECT_EQ(tick_text(a, a.ticks()[1]), "0");
  EXPECT_EQ(tick_text(a, a.ticks()[3]), "0.4");
}

TEST(Axis, SurvivesConstantsOfAnySizeAndNothing) {
  for (const double v : {0.0, 5.0, -1e-9, 3e12}) {
    const Axis a = axis_over(v, v, 4);
    EXPECT_LT(a.low, v);
    EXPECT_GT(a.high, v);
    EXPECT_LT(a.ticks().size(), 12u);
  }
  EXPECT_EQ(axis_over(INFINITY, -INFINITY, 4).high, 1);
}

TEST(Bars, EndWhereTheirValuesAre) {
  const std::string svg = draw_bars("", {{"acc", {{"a", 1, NAN}, {"b", 0.5, 0.25}, {"c", NAN, NAN}}}});
  EXPECT_THAT(svg, HasSubstr("x=\"0.0\" y=\"4.0\" width=\"240.0\""));
  EXPECT_THAT(svg, HasSubstr("x=\"0.0\" y=\"28.0\" width=\"120.0\""));
  EXPECT_THAT(svg, HasSubstr("M60.0 36.0H180.0"));  // the whisker
  EXPECT_THAT(svg, HasSubstr("no value"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(draw_bars("", {{"labels", {{"phones", 1163, NAN}, {"frames", 3.2e6, NAN}}}}),
              AllOf(HasSubstr(">1163<"), HasSubstr(">3.2e+06<")));
  EXPECT_THAT(draw_bars("", {}), HasSubstr("</svg>"));
  const std::string plain = draw_bars("", {{"frames", {{"a", 1163, NAN}, {"b", 7e-33, NAN}}}});
  EXPECT_THAT(plain, HasSubstr(">1163</text>"));
  EXPECT_THAT(plain, Not(HasSubstr("e-33")));
}

TEST(PlotBars, DrawsColumnsOfATable) {
  const Table t{"scores", "method", {"acc", "acc std"}, {"ridge"}, {{0.5, 0.1}}};
  const Plot p = PlotBars{.columns = {"acc"}}(t);
  EXPECT_EQ(p.title, "scores");
  EXPECT_THAT(p.svg, HasSubstr(">ridge<"));
  try {
    PlotBars{.columns = {"amse"}}(t);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("no column \"amse\" to draw; it has acc, acc std"));
  }
}

TEST(PlotTrajectories, ShowsTheFirstSequencesThatAllHave) {
  const Curves recorded{{"lost", "x", "y"}, {constant(5, 0), constant(5, 1), constant(5, 1)}};
  const Curves one{{"x", "y"}, {constant(5, 2), constant(5, 2)}}, other{{"y", "x"}, {constant(5, 3), constant(5, 3)}};
  const Plot p = PlotTrajectories{.sequences = 1}({{"recorded", recorded}, {"ridge", one}, {"HMM", other}});
  for (const char* shown : {">x<", ">recorded<", ">ridge<", ">HMM<"}) EXPECT_THAT(p.svg, HasSubstr(shown));
  EXPECT_THAT(p.svg, Not(HasSubstr("lost")));
  EXPECT_THAT(p.svg, Not(HasSubstr(">y<")));
  EXPECT_THAT(PlotTrajectories{}({}).svg, HasSubstr("</svg>"));
}

TEST(Svg, EscapesMarkup) { EXPECT_EQ(escape_markup("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;"); }

TEST(MeanTrajectory, ShowsTheMostFrequentPhonesAndNoSilence) {
  FrameLabels l;
  l.labels = {"sil", "sil", "aa", "aa", "b", "b", "aa", "sil"};
  const Plot p = MeanTrajectory{.phones = 1}({{"x", constant(8, 1)}}, {{"x", constant(8, 2)}}, {{"x", l}});
  EXPECT_THAT(p.svg, HasSubstr("aa (2)"));
  EXPECT_THAT(p.svg, Not(HasSubstr("b (1)")));
  EXPECT_THAT(p.svg, Not(HasSubstr("sil")));
  EXPECT_THAT(MeanTrajectory{.dimension = 2}({{"x", constant(8, 1)}}, {{"x", constant(8, 2)}}, {{"x", l}}).title,
              HasSubstr("no parameter 3"));
  EXPECT_THAT(MeanTrajectory{}({}, {}, {}).svg, HasSubstr("</svg>"));
  EXPECT_THROW(MeanTrajectory{}({{"x", constant(8, 1)}}, {{"x", constant(5, 2)}}, {{"x", l}}), std::runtime_error);
}

TEST(Svg, DrawsASpreadAsABand) {
  const Series s{"s", {0, 1}, {0, 0}, {1, 0}, true};
  EXPECT_THAT(draw_panels("", {{"", "", "", {s}}}, {1, 268, 170}),
              HasSubstr("M0.0 0.0L200.0 50.0L200.0 50.0L0.0 100.0Z"));
}

TEST(PhoneAverages, AreThoseOfAllOccurrencesWithTheirDeviation) {
  FrameLabels l;
  l.labels = {"sil", "sil", "aa", "aa", "b", "aa", "aa", "sil"};
  PhoneAverages averages(0);
  averages.add(l, {Eigen::VectorXd{{0, 0, 1, 3, 9, 5, 7, 0}}});
  const Panel panel = averages.panel("aa", {"mine"}, true);
  EXPECT_EQ(panel.title, "aa (2)");
  ASSERT_EQ(panel.series.size(), 1u);
  const Series& line = panel.series[0];  // the mean of 1 to 3 and 5 to 7
  EXPECT_EQ(line.name, "mine");
  EXPECT_DOUBLE_EQ(line.y.front(), 3);
  EXPECT_DOUBLE_EQ(line.y.at(line.y.size() / 2), 4);
  EXPECT_DOUBLE_EQ(line.y.back(), 5);
  for (const double deviation : line.spread) EXPECT_NEAR(deviation, 2, 1e-12);
  EXPECT_EQ(averages.panel("b", {"mine"}, true).series[0].y.front(), 9);
  EXPECT_TRUE(averages.panel("zh", {"mine"}, true).series[0].y.empty());
  EXPECT_EQ(averages.most_frequent(5), (std::vector<std::string>{"aa", "b"}));
}

TEST(PhoneMeans, TakesTheMostFrequentAndRefusesWhatDiffers) {
  FrameLabels l;
  l.labels = {"sil", "aa", "b", "aa", "sil", "d"};
  const Plot p = PhoneMeans{.most = 2}({{"x", constant(6, 1)}, {"unlabelled", constant(3, 1)}}, {{"x", l}});
  EXPECT_THAT(p.svg, HasSubstr("aa (2)"));
  EXPECT_THAT(p.svg, HasSubstr("b (1)"));
  EXPECT_THAT(p.svg, Not(HasSubstr("d (1)")));
  EXPECT_THAT(PhoneMeans{}({}, {}).svg, HasSubstr("</svg>"));
  EXPECT_THROW(PhoneMeans{}({{"x", constant(9, 1)}}, {{"x", l}}), std::runtime_error);
  Track other = constant(6, 1);
  other.names = {"a", "b"};
  EXPECT_THROW(PhoneMeans{}({{"x", constant(6, 1)}, {"y", other}}, {{"x", l}, {"y", l}}), std::runtime_error);
}

TEST(PlotColumns, DrawsALineADimension) {
  Track t = constant(5, 1);
  t.names = {"one", "two"};
  Context context;
  context.item = "s001";
  const Plot p = PlotColumns{"LSF"}(t, context);
  EXPECT_EQ(p.title, "LSF, s001");
  EXPECT_THAT(p.svg, HasSubstr(">one<"));
  EXPECT_THAT(p.svg, HasSubstr(">two<"));
}

TEST(PlotTracks, ShowsNoMoreDimensionsThanThereAre) {
  Context context;
  context.item = "clip";
  EXPECT_THAT(PlotTracks{}(constant(5, 0), constant(5, 1), context).svg, HasSubstr("parameter 2"));
  EXPECT_THAT(PlotTracks{}(constant(5, 0), constant(5, 1), context).svg, Not(HasSubstr("parameter 3")));
}

}  // namespace
}  // namespace talkgraph
