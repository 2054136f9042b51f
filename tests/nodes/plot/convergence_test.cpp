#include "nodes/plot/convergence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/types/gp_regression.h"
#include "nodes/types/ssgpdm.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A state of two frames that has gone from cost `from` a frame to 0 in `iterations` equal steps.
Sgpdm falling(const std::string& label, double from, int iterations, const std::string& ended) {
  Sgpdm s;
  s.label = label;
  s.latents.setZero(2, 1);
  s.lengths = {2};
  for (int i = 0; i <= iterations; ++i) s.trace.push_back(-2 * from * (1 - i / std::max(1., 1. * iterations)));
  s.ended = ended;
  return s;
}

Ssgpdm many(int states) {
  Ssgpdm model;
  for (int i = 0; i < states; ++i) {
    Sgpdm s = falling("s" + std::to_string(i), 4, 4, i % 2 ? "converged" : "iteration limit");
    for (auto& v : s.trace) v -= 2 * i;
    model.states[s.label] = s;
  }
  return model;
}

TEST(Convergence, GivesFewStatesAPanelEach) {
  Ssgpdm model;
  model.states["a"] = falling("a", 8, 4, "converged");
  model.states["b"] = falling("b", 2, 0, "iteration limit");
  const auto out = PlotConvergence{}(Value::of(model));
  EXPECT_THAT(out.plot.svg, HasSubstr(">a: converged</text>"));
  EXPECT_THAT(out.plot.svg, HasSubstr(">b: iteration limit</text>"));
  EXPECT_THAT(out.plot.svg, HasSubstr("M0.0 0.0L63.0 37.5L126.0 75.0L189.0 112.5L252.0 150.0")) << "8 to 0 a frame";
  PlotConvergence whole;
  whole.per_frame = false;
  EXPECT_THAT(whole(Value::of(model)).plot.svg, HasSubstr(">15</text>")) << "16 of both frames";
}

TEST(Convergence, ShowsManyStatesByMedianBandAndWorst) {
  const auto out = PlotConvergence{}(Value::of(many(21)));
  EXPECT_THAT(out.plot.svg, HasSubstr(">21 states</text>"));
  EXPECT_THAT(out.plot.svg, HasSubstr(">s20 (iteration limit)</text>"));
  EXPECT_THAT(out.plot.svg, HasSubstr(">s18 (iteration limit)</text>"));
  EXPECT_THAT(out.plot.svg, Not(HasSubstr(">s17")));
  // The axis is 2 to 24 over 310 pixels: the median falls from 14 to 10, the band from 6 to 22 at the start.
  EXPECT_THAT(out.plot.svg, HasSubstr("M0.0 140.9L"));
  EXPECT_THAT(out.plot.svg, HasSubstr("L792.0 197.3\" fill=\"none\" stroke=\"#222222\""));
  EXPECT_THAT(out.plot.svg, HasSubstr("M0.0 28.2L198.0 42.3L198.0 267.7L0.0 253.6Z"));
}

TEST(Convergence, CountsWhyTrainingStopped) {
  const Table table = PlotConvergence{}(Value::of(many(21))).table;
  EXPECT_THAT(table.rows, ElementsAre("converged", "iteration limit"));
  EXPECT_THAT(table.cells[0], ElementsAre(10, 4, 2));
  EXPECT_THAT(table.cells[1], ElementsAre(11, 4, 2));
}

TEST(Convergence, ShowsGaussianProcessRegression) {
  GpRegression model;
  model.frames = 2;
  model.trace = {-16, -8, 0};
  model.ended = "time limit";
  const auto out = PlotConvergence{}(Value::of(model));
  EXPECT_THAT(out.plot.svg, HasSubstr(">time limit</text>"));
  EXPECT_THAT(out.plot.svg, HasSubstr("M0.0 0.0L126.0 75.0L252.0 150.0"));
  EXPECT_THAT(out.table.cells[0], ElementsAre(1, 2, 2));
}

TEST(Convergence, EscapesLabelsAndRefusesWhatHasNoTrace) {
  EXPECT_THAT(PlotConvergence{}(Value::of(falling("<b>", 1, 2, "<i>"))).plot.svg, HasSubstr("&lt;b&gt;: &lt;i&gt;"));
  Sgpdm without = falling("a", 1, 2, "");
  EXPECT_THAT(PlotConvergence{}(Value::of(without)).table.rows, ElementsAre("not told"));
  without.trace.clear();
  EXPECT_THROW(PlotConvergence{}(Value::of(without)), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
