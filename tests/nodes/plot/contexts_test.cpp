#include "nodes/plot/contexts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talkgraph {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// After a comes b, after b either.
Vlmm small() {
  Vlmm v;
  v.alphabet = {"a", "b"};
  v.states = {{{}, {0.75, 0.25}, {1, 2}}, {{0}, {0, 1}, {-1, 2}}, {{1}, {0.99, 0.01}, {1, 2}}};
  v.occupancy = {{"a", 3}, {"a-b", 20}, {"b-a", 18}, {"b-b", 2}};
  return v;
}

TEST(PlotContexts, DrawsTreeAndAutomaton) {
  const Plot plot = PlotContexts{.title = "of \"ab\""}(small());
  EXPECT_EQ(plot.title, "of \"ab\"");
  for (const char* part :
       {"of &quot;ab&quot;: 3 memories", ">none<", ">a 0.75, b 0.25<", ">20<", ">b 1.00<", ">a 0.99<"})
    EXPECT_THAT(plot.svg, HasSubstr(part));
  EXPECT_EQ(count(plot.svg, "<rect x="), 3u);           // of the circle
  EXPECT_EQ(count(plot.svg, "Z\" fill=\"#888\""), 4u);  // b-b is too rare
  EXPECT_EQ(count(PlotContexts{.least = 0}(small()).svg, "Z\" fill=\"#888\""), 5u);
  EXPECT_EQ(count(PlotContexts{}(small()).svg, "nan"), 0u);
}

TEST(PlotContexts, DrawsTheMostOccupiedOfMany) {
  Vlmm v;
  v.states.push_back({{}, {}, {}});
  for (int i = 0; i < 20; ++i) {
    v.alphabet.push_back(std::string(1, static_cast<char>('a' + i)));
    v.states.push_back({{i}, {}, {}});
  }
  v.states.push_back({{3, 4}, {}, {}});
  for (auto& s : v.states) s.probability.assign(20, 0.05), s.next.assign(20, 0);
  v.occupancy = {{"d-e-a", 50}, {"e-a", 1}, {"c-a", 40}, {"b-a", 30}};
  const std::string svg = PlotContexts{.most = 4}(v).svg;
  EXPECT_THAT(svg, HasSubstr("4 of 22 memories"));
  for (const char* drawn : {">none<", ">e<", ">d-e<", ">c<"}) EXPECT_THAT(svg, HasSubstr(drawn));
  EXPECT_THAT(svg, Not(HasSubstr(">b<")));
  EXPECT_THAT(svg, HasSubstr("15 more"));
  EXPECT_EQ(count(svg, "<rect x="), 0u) << "too many for an automaton";
}

TEST(PlotContexts, DrawsAModelOfNothing) {
  Vlmm v;
  v.states = {{{}, {}, {}}};
  EXPECT_THAT(PlotContexts{}(v).svg, HasSubstr("1 memories"));
}

}  // namespace
}  // namespace talkgraph
