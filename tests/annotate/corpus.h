#pragma once

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "annotate/project.h"
#include "nodes/media/audio_file.h"
#include "tests/nodes/face/synthetic_face.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph::annotate {

/// A manifest of two clips of drawn faces, whose true landmarks are known.
class CorpusTest : public MediaTest {
 protected:
  static constexpr int pictures = 12;

  CorpusTest() {
    write_audio(path("a.wav"), tone(0.5, 8000));
    for (const std::string id : {"one", "two"}) {
      std::filesystem::create_directories(folder_ / id);
      for (int t = 0; t < pictures; ++t) cv::imwrite(path(fmt::format("{}/{}.png", id, t)), test::draw(face(id, t)));
    }
    Json mean = Json::array();
    const Shape usual = test::landmarks({});
    for (const auto& point : usual.rowwise()) mean.push_back({point.x(), point.y()});
    write("synthetic.json", Json{{"name", "synthetic"},
                                 {"groups", {{{"name", "all"}, {"points", {0, 1, 2}}, {"closed", true}}}},
                                 {"pairs", {{0, 1}}},
                                 {"mean", mean}}
                                .dump());
    write_manifest({clip_json("one"), clip_json("two")});
  }

  static test::SyntheticFace face(const std::string& id, std::int64_t t) {
    return test::talking_face(static_cast<int>(3 * t) + (id == "one" ? 0 : 1));
  }
  static std::string clip_json(const std::string& id, const std::string& more = "") {
    return fmt::format(R"({{"id": "{0}", "video": "{0}", "audio": "a.wav"{1}}})", id, more);
  }
  void write_manifest(const std::vector<std::string>& clips) {
    manifest_ = write("manifest.json", fmt::format("{{\"rate\": 25,\n \"clips\": [{}]}}\n", fmt::join(clips, ",\n")));
  }
  std::unique_ptr<Project> open(ProjectOptions options = {.scheme = "file"}) {
    if (options.scheme == "file" || !std::filesystem::exists(path("annotated")))
      options.scheme = path("synthetic.json");
    Diagnostics diagnostics;
    auto project = Project::open(manifest_, options, diagnostics);
    EXPECT_TRUE(project) << diagnostics.str();
    if (project) project->tell_manifest();
    return project;
  }
  static Shape truth(const Project& project, std::size_t frame) {
    return test::landmarks(face(project.clip(frame), project.frames()[frame].number));
  }
  static void finish(Project& project, std::size_t frame) {
    EXPECT_TRUE(project.annotate(frame, {truth(project, frame), true}, tag_of(project.kept(frame))).kept);
  }

  std::string manifest_;
};

}  // namespace talkgraph::annotate
