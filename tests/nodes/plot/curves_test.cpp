#include "nodes/plot/curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace talkgraph {
namespace {

using testing::HasSubstr;

TEST(PlotCurves, DrawsTheColumnsAskedFor) {
  const Table table{"kept", "mode", {"shape", "texture"}, {"1", "2"}, {{0.5, 0.25}, {1, NAN}}};
  const Plot all = PlotCurves{}(table);
  EXPECT_EQ(all.title, "kept");
  for (const char* part : {"shape", "texture", "mode"}) EXPECT_THAT(all.svg, HasSubstr(part));
  const Plot one = PlotCurves{{"shape"}, "of shape", "share"}(table);
  EXPECT_EQ(one.title, "of shape");
  EXPECT_THAT(one.svg, HasSubstr("share"));
  EXPECT_THAT(one.svg, testing::Not(HasSubstr("texture")));
  const PlotCurves unknown{{"colour"}, "", ""};
  // A tenth, one and ten lie a tick apart each, nothing is left out.
  const PlotCurves logarithms{.columns = {}, .title = "", .y_label = "", .log10 = true};
  const Plot plot = logarithms({"", "", {"n"}, {"1", "2", "3", "4"}, {{0.1}, {1}, {10}, {0}}});
  EXPECT_THAT(plot.svg, HasSubstr("-1<"));
  EXPECT_THAT(plot.svg, testing::Not(HasSubstr("inf")));
  EXPECT_THROW(unknown(table), std::runtime_error);
  EXPECT_THAT(PlotCurves{}({"none", "mode", {"shape"}, {}, {}}).svg, HasSubstr("<svg"));
}

}  // namespace
}  // namespace talkgraph
