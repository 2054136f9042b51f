#include "annotate/project.h"

#include <fmt/format.h>

#include <atomic>
#include <opencv2/imgcodecs.hpp>

#include "nodes/corpus/manifest.h"
#include "nodes/media/audio_file.h"
#include "tests/annotate/corpus.h"
#include "tests/unprivileged.h"

namespace talkgraph::annotate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

class ProjectTest : public CorpusTest {
 protected:
  std::string error(const ProjectOptions& options = {}) {
    return error_of([&] {
      Diagnostics diagnostics;
      if (!Project::open(manifest_, options, diagnostics)) throw std::runtime_error(diagnostics.str());
    });
  }
  std::unique_ptr<Project> open_manifest(const std::string& name) {
    manifest_ = path(name);
    return open();
  }
};

TEST_F(ProjectTest, TellsTheManifestWhereAnnotationsAreOnce) {
  const auto before = bytes(manifest_);
  open();
  const auto told = bytes(manifest_);
  EXPECT_THAT(told,
              HasSubstr("\n \"landmarks\": {\"folder\":\"annotated\",\"scheme\":\"synthetic.json\"},\n \"clips\": ["));
  EXPECT_EQ(told.size(), before.size() + told.find("\"clips\"") - before.find("\"clips\"")) << "nothing else changes";
  open();
  EXPECT_EQ(bytes(manifest_), told);
  EXPECT_THAT(error({.scheme = "face56"}), HasSubstr("names another point scheme"));
  EXPECT_EQ(open({.scheme = ""})->scheme().name, "synthetic");
}

TEST_F(ProjectTest, ManifestsInOneLineAndWithoutAscii) {
  write("m.json", fmt::format(R"({{"description": "Größe ✓", "rate": 25, "clips": [{}]}})", clip_json("one")));
  manifest_ = path("m.json");
  open();
  EXPECT_THAT(bytes(manifest_), HasSubstr("Größe ✓\", \"rate\": 25, \"landmarks\": "
                                          "{\"folder\":\"m-annotated\",\"scheme\":\"synthetic.json\"}, \"clips\""));
}

TEST_F(ProjectTest, AManifestKeepsItsRightsAndMayBeALink) {
  fs::create_directories(path("elsewhere"));
  fs::rename(manifest_, path("elsewhere/real.json"));
  fs::create_symlink("elsewhere/real.json", manifest_);
  fs::permissions(manifest_, fs::perms(0640));
  open();
  EXPECT_TRUE(fs::is_symlink(manifest_));
  EXPECT_THAT(bytes(path("elsewhere/real.json")), HasSubstr("\"folder\":\"annotated\""));
  EXPECT_EQ(fs::status(manifest_).permissions(), fs::perms(0640));
  const auto told = fs::last_write_time(manifest_);
  open();
  EXPECT_EQ(fs::last_write_time(manifest_), told) << "nothing is said twice";
}

TEST_F(ProjectTest, WhatCannotRunChangesNoManifest) {
  const auto before = bytes(manifest_);
  write("annotated", "a file");
  EXPECT_THAT(error({.scheme = path("synthetic.json")}), HasSubstr("annotated"));
  fs::remove(path("annotated"));
  write("one/0.png", "no picture");
  EXPECT_THAT(error({.scheme = path("synthetic.json")}), HasSubstr("0.png"));
  EXPECT_EQ(bytes(manifest_), before);
}

TEST_F(ProjectTest, AManifestChangedMeanwhileIsToldAsItIsNow) {
  Diagnostics diagnostics;
  const auto project = Project::open(manifest_, {.scheme = path("synthetic.json")}, diagnostics);
  write("manifest.json", "{\n  \"description\": \"longer\",\n" + bytes(manifest_).substr(1));
  project->tell_manifest();
  EXPECT_THAT(bytes(manifest_), HasSubstr("\"rate\": 25,\n \"landmarks\": {")) << "told where the text is now";
  EXPECT_THAT(error_of([&] { project->tell_manifest(); }), HasSubstr("was changed by another program"));
}

TEST_F(ProjectTest, AFolderThatCannotBeWrittenIsToldAtOnce) {
  write("annotated/one", "a file where a clip's folder belongs");
  EXPECT_THAT(error({.scheme = path("synthetic.json")}), HasSubstr("annotated/one"));
  fs::remove(path("annotated/one"));
  fs::permissions(path("annotated"), fs::perms(0555));
  const test::Unprivileged here;
  EXPECT_THAT(error({.scheme = path("synthetic.json")}), HasSubstr("annotated: cannot be written to: Permission"));
}

TEST_F(ProjectTest, ManifestsOfOneFolderDoNotShareAnnotations) {
  finish(*open({.frames = 3}), 0);
  write("other.json", fmt::format(R"({{"rate": 25, "clips": [{}]}})", clip_json("one")));
  const auto other = open_manifest("other.json"), first = open_manifest("manifest.json");
  EXPECT_EQ(other->folder().filename(), "other-annotated");
  EXPECT_EQ(first->folder().filename(), "annotated");
  EXPECT_FALSE(other->find(first->key(0))) << "what is meant for one does not reach the other";
}

TEST_F(ProjectTest, AKeyNamesTheFrameWhateverElseIsChosen) {
  std::string key;
  std::pair<std::string, std::int64_t> named;
  {
    manifest_ = path("./manifest.json");
    const auto project = open({.frames = 3});
    manifest_ = path("manifest.json");
    key = project->key(1);
    named = {project->clip(1), project->frames()[1].number};
  }
  {
    const auto project = open({.frames = 24, .seed = 99});
    const auto found = project->find(key);
    ASSERT_TRUE(found);
    EXPECT_EQ(std::pair(project->clip(*found), project->frames()[*found].number), named);
  }
  const auto file = fmt::format("{}/{}.png", named.first, (named.second + 1) % pictures);
  cv::imwrite(path(file), cv::Mat(200, 200, CV_8UC3, cv::Scalar(1, 2, 3)));
  EXPECT_FALSE(open({.frames = 24})->find(key)) << "other pictures";
}

TEST_F(ProjectTest, PicturesAreReadOnceAsFarAsNeededAndReadingMayBeGivenUp) {
  const auto project = open({.frames = 24});
  std::atomic<bool> cancelled = true;
  Context context;
  context.cancel = &cancelled;
  EXPECT_THROW(project->picture(5, context), Cancelled);
  cancelled = false;
  for (std::size_t f = project->frames().size(); f-- > 0;) {
    const auto picture = test::draw(face(project->clip(f), project->frames()[f].number));
    EXPECT_EQ(cv::norm(project->picture(f, context), picture, cv::NORM_INF), 0) << f;
  }
  fs::remove_all(path("one"));
  EXPECT_FALSE(project->picture(0).empty());
}

TEST_F(ProjectTest, OneBrokenFileStopsNothingElse) {
  {
    const auto project = open({.frames = 6});
    for (std::size_t f = 0; f < 3; ++f) finish(*project, f);
    write(fmt::format("annotated/{}/{:06}.draft", project->clip(4), project->frames()[4].number), "{\n1 x\n}\n");
    write("annotated/one/999999.pts",
          bytes(path(fmt::format("annotated/{}/{:06}.pts", project->clip(0), project->frames()[0].number))));
  }
  const auto project = open({.frames = 6});
  ASSERT_EQ(project->frames().size(), 7u);
  EXPECT_THAT(project->kept(4).broken, HasSubstr(".draft:2: a number is expected"));
  EXPECT_THAT(project->kept(6).broken, HasSubstr("a file of frame 999999, and the clip has the frames 0 to 11"));
  EXPECT_THAT(error_of([&] { project->picture(6); }), HasSubstr("has no frame 999999"));
  EXPECT_EQ(project->picture(4).cols, 200);
  EXPECT_EQ(project->begin(5).by, Beginning::By::model);
  EXPECT_TRUE(project->annotate(4, {truth(*project, 4), false}, tag_of(project->kept(4))).kept);
  EXPECT_TRUE(project->kept(4).annotation);
}

TEST_F(ProjectTest, OffersTrainingClipsWithoutLandmarksOfTheirOwn) {
  write("own.csv", "1,2\n");
  write_manifest({clip_json("one"), clip_json("two", R"(, "split": "test")"),
                  R"({"id": "three", "video": "one", "audio": "a.wav", "landmarks": "own.csv"})"});
  const auto project = open({.frames = 30});
  ASSERT_EQ(project->frames().size(), static_cast<std::size_t>(pictures));
  for (std::size_t f = 0; f < project->frames().size(); ++f) EXPECT_EQ(project->clip(f), "one");
  write_manifest({clip_json("two", R"(, "split": "test")")});
  EXPECT_THAT(error({.scheme = path("synthetic.json")}), HasSubstr("there is no clip to annotate"));
}

TEST_F(ProjectTest, TheFolderIsTheUsersChoice) {
  write("m.json",
        fmt::format(
            R"({{"rate": 25, "landmarks": {{"folder": "my/marks/", "scheme": "synthetic.json"}}, "clips": [{}]}})",
            clip_json("one")));
  manifest_ = path("m.json");
  for (int run = 0; run < 2; ++run) {
    Diagnostics diagnostics;
    const auto project = Project::open(manifest_, {.frames = 2}, diagnostics);
    ASSERT_TRUE(project);
    ASSERT_EQ(project->frames().size(), 2u) << "its own annotations do not count as the clip's";
    if (run == 0) finish(*project, 0);
    EXPECT_TRUE(project->kept(0).annotation);
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "my/marks/one"));
}

TEST_F(ProjectTest, WhatIsWrongIsTold) {
  EXPECT_THAT(error({.scheme = "ibug"}), HasSubstr("did you mean \"ibug68\"?"));
  write("bad.json", "{}");
  EXPECT_THAT(error({.scheme = path("bad.json")}), HasSubstr("bad.json:1:1: error: \"mean\" is missing"));
  EXPECT_THAT(error({.scheme = path("none.json")}), HasSubstr("none.json: is missing"));
  write("m.json", "{\"clips\": [{\"id\": 3}]}");
  manifest_ = path("m.json");
  EXPECT_THAT(error(), HasSubstr("m.json:1:"));
}

TEST_F(ProjectTest, RefusesPointsThatNothingCouldBeLearntFrom) {
  const auto project = open();
  const Shape good = truth(*project, 0);
  const auto annotate = [&](const Shape& points, bool done) {
    return error_of([&] { project->annotate(0, {points, done}, "none"); });
  };
  EXPECT_THAT(annotate(good.topRows(3), false), HasSubstr("points are needed, got 3"));
  Shape bad = good;
  bad(4, 0) = -1;
  EXPECT_THAT(annotate(bad, true), HasSubstr("point 4 lies outside the picture"));
  bad(4, 0) = -5000;
  EXPECT_THAT(annotate(bad, false), HasSubstr("point 4 is far outside"));
  bad(4, 0) = NAN;
  EXPECT_THAT(annotate(bad, false), HasSubstr("point 4 is far outside"));
  bad(4, 0) = -1;
  EXPECT_TRUE(project->annotate(0, {bad, false}, "none").kept) << "a draft may";
}

TEST_F(ProjectTest, BeginsWithTheSchemeThenTheExamplesThenTheModel) {
  const auto project = open({.frames = 8});
  const auto begun = project->begin(7);
  EXPECT_EQ(begun.by, Beginning::By::scheme);
  const Shape& mean = begun.points;
  EXPECT_NEAR((mean.col(0).maxCoeff() + mean.col(0).minCoeff()) / 2, 99.5, 1e-9);
  EXPECT_NEAR((mean.col(1).maxCoeff() + mean.col(1).minCoeff()) / 2, 99.5, 1e-9);

  finish(*project, 0);
  EXPECT_EQ(project->begin(7).by, Beginning::By::examples);
  EXPECT_LT(test::rms_distance(project->begin(7).points, truth(*project, 0)), 1e-9);
  project->annotate(1, {truth(*project, 1), false}, "none");
  EXPECT_LT(test::rms_distance(project->begin(7).points, truth(*project, 0)), 1e-9) << "drafts do not count";
  finish(*project, 2);
  finish(*project, 3);
  const auto fitted = project->begin(7);
  EXPECT_EQ(fitted.by, Beginning::By::model);
  EXPECT_LT(test::rms_distance(fitted.points, truth(*project, 7)), 2.5);
  finish(*project, 4);
  finish(*project, 5);
  finish(*project, 6);
  const auto better = project->begin(7);
  EXPECT_LT(test::rms_distance(better.points, truth(*project, 7)), 1);
  EXPECT_EQ(project->begin(7).points, better.points);
}

TEST_F(ProjectTest, WhatWasAnnotatedIsThereAgainAlsoIfOtherFramesAreChosen) {
  std::vector<std::pair<std::string, std::int64_t>> annotated;
  {
    const auto project = open({.frames = 3});
    for (std::size_t f = 0; f < 3; ++f) {
      finish(*project, f);
      annotated.emplace_back(project->clip(f), project->frames()[f].number);
    }
  }
  const auto project = open({.frames = 3, .seed = 99});
  std::size_t found = 0;
  for (std::size_t f = 0; f < project->frames().size(); ++f) {
    const auto annotation = project->kept(f).annotation;
    found += annotation.has_value();
    if (!annotation) continue;
    EXPECT_TRUE(annotation->done);
    EXPECT_TRUE(annotation->points.isApprox(truth(*project, f), 1e-12));
    EXPECT_THAT(annotated, testing::Contains(std::pair(project->clip(f), project->frames()[f].number)));
  }
  EXPECT_EQ(found, 3u);
}

TEST_F(ProjectTest, OneProcessAtATimeAnnotates) {
  auto project = open();
  EXPECT_THAT(error(), HasSubstr("annotated: is being annotated by another talkgraph already"));
  project.reset();
  EXPECT_EQ(error(), "no error");
}

TEST_F(ProjectTest, TheManifestGivesTheAnnotatedFramesToATrainingGraph) {
  const auto project = open({.frames = 3});
  for (std::size_t f = 0; f < 3; ++f) finish(*project, f);
  const auto number = project->frames()[0].number;
  const auto clip = project->folder() / project->clip(0);
  fs::rename(clip / fmt::format("{:06}.pts", number), clip / fmt::format("{}.PTS", number));
  EXPECT_TRUE(project->kept(0).annotation);
  auto stream = Manifest{{manifest_}}();
  std::size_t whole = 0;
  while (auto item = stream.next())
    if (item->value.landmarks)
      for (const auto& shape : item->value.landmarks->frames) whole += shape.allFinite();
  EXPECT_EQ(whole, 3u);
}

}  // namespace
}  // namespace talkgraph::annotate
