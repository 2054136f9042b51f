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
                {{"rates", "%", 0, 1, 0.5, 2, {{"Ann", {{0.25, 0, 0.5}, {0.75}}}, {"Bob", {{}, {1}}}}}});
  EXPECT_THAT(svg, HasSubstr("<title>a &amp; b</title>"));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"55.0\" cy=\"14.0\""));
  EXPECT_THAT(svg, HasSubstr("M0.0 14.0H110.0"));  // the whisker
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"165.0\" cy=\"30.0\""));
  EXPECT_THAT(svg, HasSubstr("M110.0 0v88.0\" fill=\"none\" stroke=\"#666\""));  // the reference
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"220.0\" cy=\"74.0\""));
  for (const char* text : {">Ann<", ">Bob<", ">real<", ">synthetic<", ">0.25<", ">–<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Dots, NameRowsOnceWherePanelsShareThem) {
  const auto count = [](const std::string& text, const std::string& part) {
    int n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const DotPanel one{"one", "", 0, 1, NAN, 0, {{"Ann", {{0.5}}}}}, other{"two", "", 0, 1, NAN, 0, {{"Bob", {{0.5}}}}};
  EXPECT_EQ(count(draw_dots("", {"a"}, {one, one}), ">Ann<"), 1);
  EXPECT_EQ(count(draw_dots("", {"a"}, {one, one}, 1), ">Ann<"), 2) << "below each other";
  EXPECT_EQ(count(draw_dots("", {"a"}, {one, other, one}, 3), ">Ann<"), 2);
}

TEST(Dots, SurviveNothing) {
  EXPECT_THAT(draw_dots("", {}, {}), HasSubstr("</svg>"));
  EXPECT_THAT(draw_dots("", {"a"}, {{"t", "", 1, 5, NAN, 0, {}}}), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace talkgraph
