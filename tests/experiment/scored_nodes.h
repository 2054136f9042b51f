#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "graph/output_file.h"
#include "graph/registry.h"
#include "nodes/types/report.h"
#include "tests/temporary_folder.h"

namespace talkgraph::test {

/// How often ScoreNumber was called in this process.
inline std::atomic<int> scored{0};

/// The numbers 1 to `items`, as scores "x".
struct NumberItems {
  int items = 3;
  Stream<Scores> operator()() const {
    std::vector<Item<Scores>> all;
    for (int i = 1; i <= items; ++i) all.push_back({std::to_string(i), Scores{{{"x", i}}}});
    return Stream<Scores>(std::move(all));
  }
};
inline void describe(Description<NumberItems>& d) {
  d.type("test.items").summary("numbers").output("number", "1 to items");
  d.param("items", &NumberItems::items).at_least(0).doc("how many");
}

/// scale * x + offset + noise; fails on x of `fail_on`.
struct ScoreNumber {
  double scale = 1, offset = 0, noise = 0, fail_on = -1;
  std::string title;
  Scores operator()(const Scores& number, Random& random) const {
    ++scored;
    const double x = number.values.at("x");
    if (x == fail_on) throw std::runtime_error("this number is not liked");
    return {{{"y", scale * x + offset + noise * random.normal()}, {"title", static_cast<double>(title.size())}}};
  }
};
inline void describe(Description<ScoreNumber>& d) {
  d.type("test.score").summary("a line").stored();
  d.input("number").output("scores", "of a line; y: its height at x, px; title: letters of <the title>");
  d.param("scale", &ScoreNumber::scale).doc("slope");
  d.param("offset", &ScoreNumber::offset).doc("height");
  d.param("noise", &ScoreNumber::noise).doc("standard deviation");
  d.param("fail_on", &ScoreNumber::fail_on).doc("number that fails");
  d.param("title", &ScoreNumber::title).doc("a text");
}

/// A picture of the item.
struct WritePicture {
  Artifact operator()(const Scores&, Context& context) const {
    write_file(context.folder / "pictures" / (context.item + ".svg"), "<svg/>");
    return {"pictures/" + context.item + ".svg", "a picture"};
  }
};
inline void describe(Description<WritePicture>& d) {
  d.type("test.picture").summary("writes a picture").sink();
  d.input("scores").output("file");
}

inline Registry scored_registry() {
  Registry r;
  r.add<NumberItems>();
  r.add<ScoreNumber>();
  r.add<WritePicture>();
  return r;
}

inline const char* const scored_graph = R"({
  "parameters": { "scale": { "default": 1 }, "offset": { "default": 0 }, "noise": { "default": 0 },
                  "fail_on": { "default": -1 }, "title": { "default": "" } },
  "nodes": {
    "items": { "type": "test.items" },
    "score": { "type": "test.score", "in": { "number": "items" }, "params": { "scale": "${scale}", "offset": "${offset}",
               "noise": "${noise}", "fail_on": "${fail_on}", "title": "${title}" } },
    "picture": { "type": "test.picture", "in": { "scores": "score" } }
  },
  "outputs": { "scores": "score", "files": "picture" }
})";

/// A folder with the experiments one.json, a run with pictures, and two.json, two slopes, and series of them.
class ScoredExperiments : public ::testing::Test {
 protected:
  ScoredExperiments() {
    folder_.write("graph.json", scored_graph);
    folder_.write("one.json", R"({ "graph": "graph.json", "tabulate": ["scores"], "show": ["files"] })");
    folder_.write("two.json", R"({ "graph": "graph.json", "description": "Slopes", "tabulate": ["scores"],
                                   "vary": { "scale": [1, 2] } })");
  }
  std::string series(const std::string& sections) {
    return folder_.write("story.json", R"({ "description": "A story", "sections": [)" + sections + "] }");
  }

  const TemporaryFolder folder_;
};

}  // namespace talkgraph::test
