#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "nodes/plot/mean_trajectory.h"
#include "nodes/plot/svg.h"
#include "nodes/plot/tracks.h"

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
  const std::string svg = draw_panels({{"t", "x", "y", {{"s", {0, 1}, {0, 1}}}}}, 1);
  EXPECT_THAT(svg, HasSubstr("M0.0 152.0L256.0 0.0"));
}

TEST(Svg, SurvivesNothingConstantsAndNaN) {
  EXPECT_THAT(draw_panels({}, 3), HasSubstr("</svg>"));
  const std::string svg = draw_panels({{"t", "", "", {{"s", {0, 1, 2}, {NAN, 5, 5}}, {"empty", {}, {}}}}}, 2);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Svg, EscapesMarkup) { EXPECT_EQ(escape_markup("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;"); }

TEST(MeanTrajectory, ShowsTheMostFrequentPhonesAndNoSilence) {
  FrameLabels l;
  l.labels = {"sil", "sil", "aa", "aa", "b", "b", "aa", "sil"};
  const Plot p = MeanTrajectory{.phones = 1}({{"x", constant(8, 1)}}, {{"x", constant(8, 2)}}, {{"x", l}});
  EXPECT_THAT(p.svg, HasSubstr("aa (2)"));
  EXPECT_THAT(p.svg, Not(HasSubstr("b (1)")));
  EXPECT_THAT(p.svg, Not(HasSubstr("sil")));
  EXPECT_THROW(MeanTrajectory{.dimension = 2}({{"x", constant(8, 1)}}, {{"x", constant(8, 2)}}, {{"x", l}}),
               std::runtime_error);
  EXPECT_THAT(MeanTrajectory{}({}, {}, {}).svg, HasSubstr("</svg>"));
}

TEST(PlotTracks, ShowsNoMoreDimensionsThanThereAre) {
  Context context;
  context.item = "clip";
  EXPECT_THAT(PlotTracks{}(constant(5, 0), constant(5, 1), context).svg, HasSubstr("parameter 2"));
  EXPECT_THAT(PlotTracks{}(constant(5, 0), constant(5, 1), context).svg, Not(HasSubstr("parameter 3")));
}

}  // namespace
}  // namespace talkgraph
