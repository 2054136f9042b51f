#include "nodes/types/scheme.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/source_folder.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

std::string complaints(const std::string& text) {
  Diagnostics diagnostics;
  const auto scheme = parse_scheme(std::make_shared<SourceText>(SourceText{"s.json", text}), diagnostics);
  EXPECT_EQ(scheme.has_value(), diagnostics.ok());
  return diagnostics.str();
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "no error";
}

constexpr auto tiny = R"({"name": "tiny", "groups": [{"name": "chin", "points": [0, 1], "closed": true}],
  "names": {"tip": 2}, "pairs": [[0, 1]], "triangles": [[0, 1, 2]], "mean": [[0, 0], [2, 0], [1, 3.5]]})";

TEST(PointScheme, IsReadFromJson) {
  const auto scheme = *find_scheme(tiny);
  EXPECT_EQ(scheme.name, "tiny");
  EXPECT_EQ(scheme.points(), 3);
  EXPECT_EQ(scheme.mean, (Shape(3, 2) << 0, 0, 2, 0, 1, 3.5).finished());
  EXPECT_TRUE(scheme.groups.at(0).closed);
  EXPECT_THAT(scheme.named("chin"), ElementsAre(0, 1));
  EXPECT_THAT(scheme.named("tip"), ElementsAre(2));
  EXPECT_EQ(scheme.point("tip"), 2);
  EXPECT_THAT(scheme.pairs, ElementsAre(std::pair(0, 1)));
  EXPECT_EQ(scheme.triangles, (Triangles(1, 3) << 0, 1, 2).finished());
}

TEST(PointScheme, UnknownNamesAreToldWithTheNearest) {
  const auto scheme = *find_scheme(tiny);
  EXPECT_THAT(error_of([&] { scheme.named("shin"); }),
              HasSubstr("\"tiny\" has no group or point \"shin\" (did you mean \"chin\"?)"));
  EXPECT_THAT(error_of([&] { scheme.point("chin"); }), HasSubstr("\"chin\" of the point scheme \"tiny\" is 2 points"));
  EXPECT_THAT(error_of([] { scheme_of("ibug", 68); }), HasSubstr("did you mean \"ibug68\"?"));
  EXPECT_THAT(error_of([] { scheme_of("ibug68", 5); }), HasSubstr("\"ibug68\" has 68 points, the landmarks 5"));
  EXPECT_THAT(error_of([] { scheme_of("", 5); }), HasSubstr("which of 5 landmarks is which"));
  EXPECT_THAT(error_of([] { scheme_of(LandmarkTrack{}); }), HasSubstr("no landmarks"));
  EXPECT_EQ(scheme_of("", 68).name, "ibug68");
  EXPECT_FALSE(find_scheme("synthetic"));
}

TEST(PointScheme, AllThatIsWrongIsToldWithItsPlace) {
  const std::string said = complaints(R"({"nam": "x", "groups": [
{"name": "a", "points": [0, 3]},
{"name": "a", "points": [1, 1]},
{"name": "b", "points": [], "closed": 1},
7], "names": {"a": 0, "t": 1.5},
"pairs": [[0, 1], [1, 2], [2]],
"triangles": [[0, 1, 1], [0, 1]],
"mean": [[0, 0], [2, 0], [1, 3]]})");
  for (const char* expected :
       {"s.json:1:2: error: unknown member \"nam\" (did you mean \"name\"?)", "s.json:1:1: error: \"name\" is missing",
        "s.json:2:29: error: a point is expected, 0 to 2", "s.json:3:10: error: the name \"a\" is taken already",
        "s.json:3:29: error: point 1 stands here twice", "s.json:4:25: error: a group needs a point",
        "s.json:4:39: error: \"closed\" is true or false; got a number", "s.json:5:1: error: a group is an object",
        "s.json:5:15: error: the name \"a\" is taken already", "s.json:5:28: error: a point is expected",
        "s.json:6:19: error: point 1 is in another pair already", "s.json:6:27: error: a pair is [point, point]",
        "s.json:7:22: error: point 1 stands here twice", "s.json:7:26: error: a triangle is [point, point, point]"})
    EXPECT_THAT(said, HasSubstr(expected));
  EXPECT_THAT(complaints("[]"), HasSubstr("s.json:1:1: error: a scheme is an object"));
  EXPECT_THAT(complaints(R"({"name": "x"})"), HasSubstr("\"mean\" is missing"));
  EXPECT_THAT(complaints(R"({"name": "x", "mean": [[0, 1], [0, 2]]})"), HasSubstr("at least 3 points, got 2"));
  EXPECT_THAT(complaints(R"({"name": "x", "mean": [[0, 1], [0, 2], [0, 3]]})"), HasSubstr("lie on one line"));
  EXPECT_THAT(complaints(R"({"name": "", "mean": [[0, 1], 3, [2, "x"]]})"), HasSubstr("a list of [x, y]"));
  EXPECT_THAT(complaints("{"), HasSubstr("s.json:1:"));
}

TEST(PointScheme, AFaceWithoutAreaOrNamesIsRefused) {
  const auto of = [](const std::string& rest) { return complaints("{\"name\": \"x\", " + rest + "}"); };
  EXPECT_THAT(of(R"("mean": [[0, 0], [1, 1], [2, 2.0000001]])"), HasSubstr("lie on one line"));
  EXPECT_THAT(of(R"("mean": [[1, 1], [1, 1], [1, 1]])"), HasSubstr("lie on one line"));
  EXPECT_THAT(of("\n\"mean\": [[0, 0], [5, 0], [2, 3],\n[5, 0]]"),
              HasSubstr("s.json:3:1: error: point 3 lies where point 1"));
  EXPECT_THAT(of("\n\"mean\": [[0, 0], [1e200, 0], [2, 3]]"),
              HasSubstr("s.json:2:19: error: a number from -1e+06 to 1e+06 is expected"));
  EXPECT_EQ(of(R"("mean": [[0, 0], [1e-9, 0], [0, 1e-9]])"), "");
  const std::string mean = R"("mean": [[0, 0], [5, 0], [2, 3]], )";
  EXPECT_THAT(of(mean + R"("triangles": [[0, 1, 2],)"
                        "\n[2, 0, 1]]"),
              HasSubstr("s.json:2:1: error: this triangle stands here twice"));
  EXPECT_THAT(of(mean + R"("names": {"": 1})"), HasSubstr("a name must not be empty"));
}

TEST(PointScheme, TheExampleOfTheDocumentationServesThePipelines) {
  std::ifstream page(test::source("/docs/schemes.md"));
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  const auto from = text.find("```json") + 7;
  const auto scheme = *find_scheme(text.substr(text.find('{', from), text.find("```", from) - text.find('{', from)));
  for (const char* part : {"mouth_left", "mouth_top", "mouth_right", "mouth_bottom", "inner_top", "inner_bottom"})
    EXPECT_NO_THROW(scheme.point(part)) << part;
  for (const char* group : {"outer_lips", "inner_lips"}) EXPECT_GE(scheme.named(group).size(), 3u) << group;
}

TEST(PointScheme, BuiltInOnesAreWhole) {
  EXPECT_THAT(built_in_schemes(), IsSupersetOf({"ibug68", "face56", "face69"}));
  for (const auto& name : built_in_schemes()) {
    const auto scheme = *find_scheme(name);
    EXPECT_EQ(scheme.name, name);
    EXPECT_EQ(std::to_string(scheme.points()), name.substr(4)) << "the name says how many";
    std::vector<int> drawn(static_cast<std::size_t>(scheme.points()));
    for (const auto& group : scheme.groups)
      for (const int point : group.points) ++drawn[static_cast<std::size_t>(point)];
    EXPECT_EQ(drawn, std::vector<int>(drawn.size(), 1)) << name << ": each point is in one group";
    for (const auto& [left, right] : scheme.pairs) {
      EXPECT_LT(scheme.mean(left, 0), scheme.mean(right, 0));
      EXPECT_NEAR(scheme.mean(left, 0), -scheme.mean(right, 0), 0.11) << name << " " << left;
      EXPECT_NEAR(scheme.mean(left, 1), scheme.mean(right, 1), 0.11) << name << " " << left;
    }
    EXPECT_LT(scheme.mean(scheme.point("inner_top"), 1), scheme.mean(scheme.point("inner_bottom"), 1));
    EXPECT_LT(scheme.mean(scheme.point("mouth_top"), 1), scheme.mean(scheme.point("inner_top"), 1));
    EXPECT_GT(scheme.mean(scheme.point("mouth_bottom"), 1), scheme.mean(scheme.point("inner_bottom"), 1));
    EXPECT_LT(scheme.mean(scheme.point("mouth_left"), 0), scheme.mean(scheme.point("mouth_right"), 0));
  }
}

}  // namespace
}  // namespace talkgraph
