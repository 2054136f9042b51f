#include "experiment/meanings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/types/report.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;

NodeType node_type(const char* doc, PortType port = port_type<Scores>) {
  NodeType type;
  PortSpec& output = type.outputs.emplace_back();
  output.doc = doc;
  output.type = port;
  return type;
}

std::vector<Meaning> of_types(const std::vector<NodeType>& types, const std::vector<std::string>& measures) {
  std::vector<Graph> graphs;
  for (const auto& type : types) graphs.emplace_back().nodes.emplace_back().type = &type;
  return meanings_of(measures, graphs);
}

TEST(Meanings, AreReadFromTheDescriptionsOfOutputs) {
  const auto type = node_type("one row; lmd: distance, px; lag: shift, above 0: late; plain");
  EXPECT_THAT(of_types({type}, {"lag", "lmd", "plain", "row", "one row"}),
              ElementsAre(Meaning{"lag", "shift, above 0: late"}, Meaning{"lmd", "distance, px"}));
  EXPECT_TRUE(of_types({node_type("")}, {"", "lmd"}).empty());
  EXPECT_TRUE(meanings_of({"lmd"}, {}).empty());
}

TEST(Meanings, StandForAllNamesThatEndAlike) {
  const auto type = node_type("x won: sequences; x_correct: read right; x: any", port_type<Table>);
  EXPECT_THAT(of_types({type}, {"acc won", "phone_correct", "correct", "acc"}),
              ElementsAre(Meaning{"acc won", "sequences"}, Meaning{"phone_correct", "read right"}));
}

TEST(Meanings, AreOfScoresAndTablesOnlyTheFirstCounts) {
  EXPECT_THAT(
      of_types({node_type("acc: of a plot", port_type<Plot>), node_type("acc: first"), node_type("acc: second")},
               {"acc"}),
      ElementsAre(Meaning{"acc", "first"}));
}

TEST(Meanings, AreFoldedAndEscaped) {
  EXPECT_EQ(html_meanings({}), "");
  const auto html = html_meanings({{"a<b", "\"share\" & more"}});
  EXPECT_THAT(html, testing::StartsWith("<details><summary>What the measures are</summary>"));
  EXPECT_THAT(html, testing::HasSubstr("<dt>a&lt;b</dt><dd>&quot;share&quot; &amp; more</dd>"));
  EXPECT_THAT(html, testing::HasSubstr("docs/measures.md"));
}

}  // namespace
}  // namespace talkgraph
