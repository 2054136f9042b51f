#include "nodes/plot/dots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Dots, LieWhereTheirValuesAre) {
  const std::string svg =
      draw_dots("a & b", {"real", "synthetic"},
                {{"rates", "%", 0, 1, 0.5, {{"Ann", {{0.25, 0, 0.5}, {0.75}}}, {"Bob", {{}, {1}}}}}});
  EXPECT_THAT(svg, HasSubstr("<title>a &amp; b</title>"));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"65.0\" cy=\"14.0\""));
  EXPECT_THAT(svg, HasSubstr("M0.0 14.0H130.0"));  // the whisker
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"195.0\" cy=\"30.0\""));
  EXPECT_THAT(svg, HasSubstr("M130.0 0v88.0\" fill=\"none\" stroke=\"#666\""));  // the reference
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"260.0\" cy=\"74.0\""));
  for (const char* text : {">Ann<", ">Bob<", ">real<", ">synthetic<", ">0.25<", ">–<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Dots, SurviveNothing) {
  EXPECT_THAT(draw_dots("", {}, {}), HasSubstr("</svg>"));
  EXPECT_THAT(draw_dots("", {"a"}, {{"t", "", 1, 5, NAN, {}}}), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace talkgraph
