#include "study/make.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "graph/output_file.h"
#include "nodes/all_nodes.h"
#include "nodes/face/build.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/media/video_file.h"
#include "nodes/types/mouths.h"
#include "nodes/types/recording.h"
#include "runtime/run_folder.h"
#include "tests/nodes/face/synthetic_face.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::study {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const std::vector<int> eye_points = {16, 17, 18, 19, 20, 21, 22, 23}, lip_points = {28, 29, 30, 31, 32, 33, 34, 35};

/// Faces whose eyes are shut in every third.
AppearanceModel blinking_model() {
  auto prototypes = test::synthetic_prototypes();
  for (std::size_t i = 0; i < prototypes.shapes.size(); i += 3)
    for (const int from : {16, 20}) {
      const Eigen::RowVector2d middle = prototypes.shapes[i].middleRows(from, 4).colwise().mean();
      cv::circle(prototypes.images[i].pixels, cv::Point2d(middle.x(), middle.y()), 7, {120, 150, 200}, cv::FILLED);
    }
  Context context;
  auto model = BuildAppearance{}(prototypes, context);
  Json mean = Json::array();
  for (const auto& point : model.mean_shape.rowwise()) mean.push_back({point.x(), point.y()});
  model.scheme = Json{
      {"name", "synthetic"},
      {"groups",
       {{{"name", "left_eye"}, {"points", {16, 17, 18, 19}}, {"closed", true}},
        {{"name", "right_eye"}, {"points", {20, 21, 22, 23}}, {"closed", true}},
        {{"name", "nose_bridge"}, {"points", {24, 27}}},
        {{"name", "nose_base"}, {"points", {25, 26}}},
        {{"name", "outer_lips"}, {"points", lip_points}, {"closed", true}}}},
      {"mean", mean}}.dump();
  return model;
}
const AppearanceModel& model() {
  static const AppearanceModel built = blinking_model();
  return built;
}

struct GiveFace {
  AppearanceModel operator()() const { return model(); }
};
void describe(Description<GiveFace>& d) { d.type("test.face").summary("a face").output("model"); }

struct NoMouths {
  Mouths operator()() const { return {}; }
};
void describe(Description<NoMouths>& d) { d.type("test.mouths").summary("none").output("mouths"); }

/// Recordings a0, a1, ... held out, and b0, b1, ... to train on.
struct Talkers {
  int held_out = 4;
  bool same = false;
  Stream<Recording> operator()() const {
    std::vector<Item<Recording>> all;
    for (int i = 0; i < held_out + 4; ++i) {
      Recording r;
      r.id = (i < held_out ? "a" : "b") + std::to_string(i);
      r.split = i < held_out ? "test" : "train";
      r.transcript = Transcript{same ? "Again." : "Sentence " + std::to_string(10 + i) + "."};
      r.audio = [i] {
        Audio audio;
        audio.samples.resize(static_cast<Eigen::Index>(0.4 * audio.rate));
        for (Eigen::Index t = 0; t < audio.samples.size(); ++t)
          audio.samples[t] = 0.3 * std::sin(0.02 * (i + 1) * static_cast<double>(t));
        return audio;
      };
      r.key = [i] { return KeyMaker().add(std::to_string(i)).key(); };
      all.push_back({r.id, std::move(r)});
    }
    return Stream<Recording>(std::move(all));
  }
};
void describe(Description<Talkers>& d) {
  d.type("test.talkers").summary("recordings").output("recording");
  d.param("held_out", &Talkers::held_out).at_least(0).doc("how many");
  d.param("same", &Talkers::same).doc("all say the same");
}

struct Moves {
  Track recorded, synthesised, mean;
};
/// The face's mouth and eyes move; imitated with an error, and a frame longer.
struct Move {
  double error = 0.5;
  std::string fails;
  Moves operator()(const AppearanceModel& face, const Recording& recording, Random& random) const {
    if (recording.id == fails) throw std::runtime_error("this one fails");
    Moves out;
    const auto draw = [&](Eigen::Index frames) {
      Eigen::MatrixXd values(frames, face.modes());
      for (auto& v : values.reshaped()) v = random.normal();
      return Eigen::MatrixXd(values * face.combined_variances.cwiseSqrt().asDiagonal());
    };
    out.recorded.start = out.synthesised.start = 0.02;
    out.recorded.values = draw(6);
    out.synthesised.values = Eigen::MatrixXd::Zero(7, face.modes());
    out.synthesised.values.topRows(6) = out.recorded.values + error * draw(6);
    out.mean.values = 0.1 * draw(1);
    return out;
  }
};
void describe(Description<Move>& d) {
  d.type("test.move").summary("moves").input("face").input("recording");
  d.output("recorded", &Moves::recorded).output("synthesised", &Moves::synthesised).output("mean", &Moves::mean);
  d.param("error", &Move::error).doc("share of the variance");
  d.param("fails", &Move::fails).doc("recording");
}

const Registry& registry() {
  static const Registry all = [] {
    Registry r = all_nodes();
    r.add<GiveFace>();
    r.add<NoMouths>();
    r.add<Talkers>();
    r.add<Move>();
    return r;
  }();
  return all;
}

const char* const run_graph = R"({
  "parameters": { "held_out": { "default": 4 }, "same": { "default": false }, "error": { "default": 0.5 }, "fails": { "default": "" } },
  "nodes": {
    "talkers": { "type": "test.talkers", "params": { "held_out": "${held_out}", "same": "${same}" } },
    "held": { "type": "corpus.select", "in": { "recording": "talkers" }, "params": { "splits": ["test"] } },
    "train": { "type": "corpus.select", "in": { "recording": "talkers" }, "params": { "splits": ["train"] } },
    "parts": { "type": "corpus.parts", "in": { "recording": "held" }, "params": { "check": false } },
    "face": { "type": "test.face" },
    "mouths": { "type": "test.mouths" },
    "move": { "type": "test.move", "in": { "face": "face", "recording": "held" }, "params": { "error": "${error}", "fails": "${fails}" } },
    "restore": { "type": "normalise.restore", "in": { "centred": "move.synthesised", "mean": "move.mean" } },
    "write": { "type": "write.track", "in": { "track": "move.recorded" } }
  },
  "outputs": { "train": "train", "restored": "restore", "recorded": "move.recorded", "mouths": "mouths", "audio": "parts.audio" }
})";

const char* const ports = R"("take": { "face": "face", "recorded": "move.recorded", "synthesised": "restore.centred",
    "mean": "restore.mean", "mouths": "mouths.mouths", "audio": "parts.audio", "recordings": "held", "sentences": "train" })";

class MakeTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  }

  fs::path finished_run(const std::string& name, const std::vector<std::string>& sets = {}, bool keep_going = false) {
    Diagnostics diagnostics;
    const auto graph = load_graph_text("g.json", run_graph, registry(), diagnostics, {sets});
    EXPECT_TRUE(graph) << diagnostics.str();
    const fs::path path = files_.path() / name;
    RunFolder folder(*graph, path);
    RunOptions options;
    options.folder = path;
    options.keep_going = keep_going;
    options.observers = {&folder};
    run(*graph, options);
    return path;
  }

  static std::string with_tests(const std::string& tests, const std::string& more) {
    return fmt::format(R"({}, "draw": "small.json", "tests": {{ {} }}{})", ports, tests, more);
  }
  /// Four clips of each test but the perceptual one, which has eight.
  static std::string members(const std::string& more = "") {
    return with_tests(R"("turing": { "clips": 4, "pool": 4 }, "perceptual": { "clips": 8, "pool": 8 },
                         "intelligibility": { "clips": 4, "pool": 4 })",
                      more);
  }

  std::optional<MadeStudy> make(const std::vector<fs::path>& runs, const std::string& changes) {
    files_.write("small.json", fmt::format(R"({{ "extends": "{}", "parameters": {{ "size": {{ "default": {} }} }} }})",
                                           test::source("/pipelines/fragments/study-clip.json"), size_));
    const auto file = files_.write(
        "s.json", fmt::format(R"({{ "extends": "{}", {} }})", test::source("/pipelines/studies/study.json"), changes));
    diagnostics_ = {};
    const auto design = load_design(file, diagnostics_);
    EXPECT_TRUE(design) << diagnostics_.str();
    if (!design) return {};
    const auto run_below = [&](const Graph& graph, const fs::path& folder) {
      RunOptions options;
      options.folder = folder;
      options.cache = cache_.get();
      return run(graph, options);
    };
    return make_study(*design, runs, folder_, registry(), run_below, diagnostics_);
  }

  std::string complaint(const std::vector<fs::path>& runs, const std::string& changes) {
    try {
      EXPECT_FALSE(make(runs, changes));
      return diagnostics_.str();
    } catch (const std::exception& e) {
      return e.what();
    }
  }

  std::string file(const Clip& clip, const std::string& format = "webm") const {
    return (folder_ / "clips" / (clip.id + "." + format)).string();
  }
  std::string bytes(const Clip& clip, const std::string& format) const {
    std::ifstream in(file(clip, format), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<cv::Mat> frames(const Clip& clip, const std::string& format = "webm") const {
    return open_video(file(clip, format)).read_all();
  }

  const test::TemporaryFolder files_;
  const fs::path folder_ = files_.path() / "study";
  int size_ = 60;  ///< of pictures: small ones are encoded faster
  std::unique_ptr<Cache> cache_;
  Diagnostics diagnostics_;
};

/// Where points of the mean face lie in pictures of the whole face.
cv::Rect place(const std::vector<int>& points) {
  const Shape& mean = model().mean_shape;
  const Eigen::RowVector2d low = mean.colwise().minCoeff(), high = mean.colwise().maxCoeff();
  const double zoom = 300 / (1.2 * (high - low).maxCoeff());
  Shape at = zoom * (mean(points, Eigen::all).rowwise() - 0.5 * (low + high));
  at.array() += 150;
  const Eigen::RowVector2d from = at.colwise().minCoeff(), to = at.colwise().maxCoeff();
  return {cv::Point2d(from.x(), from.y()), cv::Point2d(to.x(), to.y())};
}

double difference(const cv::Mat& a, const cv::Mat& b, const cv::Rect& where) {
  return cv::norm(a(where), b(where), cv::NORM_L1) / where.area() / 3;
}

double movement(const std::vector<cv::Mat>& clip, const cv::Rect& where) {
  double sum = 0;
  for (std::size_t t = 1; t < clip.size(); ++t) sum += difference(clip[t], clip[t - 1], where);
  return sum / static_cast<double>(clip.size() - 1);
}

TEST_F(MakeTest, WritesWhatAServerReads) {
  size_ = 300;
  const auto made = make({finished_run("ann"), finished_run("bob", {"held_out=6"})}, members());
  ASSERT_TRUE(made) << diagnostics_.str();
  const auto study = read_study(folder_);
  ASSERT_EQ(study.tests.size(), 3u);
  std::size_t clips = 0;
  for (const auto& test : study.tests) {
    std::map<std::string, int> categories;
    for (const auto& clip : test.clips) {
      ++clips;
      ++categories[clip.category()];
      EXPECT_DOUBLE_EQ(clip.seconds, 0.24);
      for (const auto& format : {"webm", "mp4"}) {
        const auto video = open_video(file(clip, format)).source;
        EXPECT_EQ(video->size(), cv::Size(300, 300));
        EXPECT_EQ(video->frames(), 6);
        EXPECT_EQ(video->rate(), Rational(25));
        for (const auto& telling : {"ann", "bob", "synth", "recorded", "Lavc"})
          EXPECT_EQ(bytes(clip, format).find(telling), std::string::npos) << telling;
      }
      EXPECT_TRUE(test.kind == TestKind::intelligibility ? clip.choices.size() == 4 : clip.choices.empty());
    }
    EXPECT_EQ(categories.size(), test.kind == TestKind::perceptual ? 8u : 4u);
    for (const auto& [category, count] : categories) EXPECT_EQ(count, 1) << category;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "clips"), {}), static_cast<std::ptrdiff_t>(2 * clips));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
}

TEST_F(MakeTest, GivesSoundToAllButSilentClips) {
  ASSERT_TRUE(make({finished_run("ann")}, members()));
  const auto study = read_study(folder_);
  for (const auto& test : study.tests)
    for (const auto& clip : test.clips)
      for (const auto& format : {"webm", "mp4"}) {
        if (test.kind == TestKind::intelligibility)
          EXPECT_THROW(ffmpeg_audio(file(clip, format)), std::runtime_error);
        else
          EXPECT_NEAR(ffmpeg_audio(file(clip, format)).samples.cwiseAbs().maxCoeff(), 0.3, 0.1) << format;
      }
}

// Whatever differs between a real and a synthetic clip but the movement would give it away.
TEST_F(MakeTest, DrawsARealAndASyntheticClipOfOneMovementAlike) {
  ASSERT_TRUE(make({finished_run("ann", {"held_out=2", "error=0"})}, members()));
  const auto study = read_study(folder_);
  for (const auto& test : study.tests) {
    std::map<std::string, std::vector<Clip>> alike;
    for (const auto& clip : test.clips) alike[clip.sequence + clip.eyes].push_back(clip);
    for (const auto& [name, clips] : alike) {
      ASSERT_EQ(clips.size(), 2u) << name;
      EXPECT_NE(clips[0].synthetic, clips[1].synthetic);
      for (const auto& format : {"webm", "mp4"}) EXPECT_EQ(bytes(clips[0], format), bytes(clips[1], format)) << name;
    }
  }
}

TEST_F(MakeTest, PastesEyesThatMoveOrDoNot) {
  size_ = 300;
  ASSERT_TRUE(
      make({finished_run("ann", {"held_out=2"})},
           with_tests(R"("turing": null, "intelligibility": null, "perceptual": { "clips": 8, "pool": 8 })", "")));
  const auto study = read_study(folder_);
  const auto eyes = place(eye_points), lips = place(lip_points);
  const auto find = [&](const std::string& sequence, bool synthetic, const std::string& of_eyes) {
    for (const auto& clip : study.tests[0].clips)
      if (clip.sequence == sequence && clip.synthetic == synthetic && clip.eyes == of_eyes) return frames(clip);
    return std::vector<cv::Mat>();
  };
  for (const std::string sequence : {"a0", "a1"}) {
    std::map<bool, std::vector<cv::Mat>> still, recorded;
    for (const bool synthetic : {false, true}) {
      still[synthetic] = find(sequence, synthetic, "static"),
      recorded[synthetic] = find(sequence, synthetic, "recorded");
      ASSERT_EQ(still[synthetic].size(), 6u);
      ASSERT_EQ(recorded[synthetic].size(), 6u);
      EXPECT_LT(movement(still[synthetic], eyes), 0.35 * movement(recorded[synthetic], eyes));
      EXPECT_GT(movement(still[synthetic], lips), 3);
    }
    for (std::size_t t = 0; t < 6; ++t) {
      for (const bool synthetic : {false, true})
        EXPECT_LT(difference(still[synthetic][t], recorded[synthetic][t], lips), 2);
      EXPECT_LT(difference(still[false][t], still[true][t], eyes), 4);
      EXPECT_LT(difference(recorded[false][t], recorded[true][t], eyes), 4);
    }
  }
}

TEST_F(MakeTest, ShowsTheLowerHalfInTheTuringTest) {
  size_ = 300;
  ASSERT_TRUE(
      make({finished_run("ann")},
           with_tests(R"("perceptual": null, "intelligibility": null, "turing": { "clips": 4, "pool": 4 })", "")));
  const auto study = read_study(folder_);
  for (const auto& clip : study.tests[0].clips) {
    const auto picture = frames(clip)[3];
    const cv::Mat flat(picture.size(), picture.type(), cv::Scalar::all(128));
    EXPECT_LT(difference(picture, flat, {0, 0, 300, 30}), 2);
    EXPECT_GT(difference(picture, flat, {100, 120, 100, 60}), 10);
  }
}

TEST_F(MakeTest, GoesByItsSeedAndFindsWhatWasDrawn) {
  cache_ = std::make_unique<Cache>(files_.path() / "cache");
  const auto run = finished_run("ann");
  const auto text = [&] { return files_.read("study/study.json"); };
  ASSERT_TRUE(make({run}, members()));
  const auto first = text();
  const auto one = read_study(folder_).tests[0].clips[0];
  const auto picture = bytes(one, "webm");
  fs::remove_all(folder_);
  ASSERT_TRUE(make({run}, members()));
  EXPECT_EQ(text(), first);
  EXPECT_EQ(bytes(one, "webm"), picture);
  fs::remove_all(folder_);
  ASSERT_TRUE(make({run}, members(R"(, "seed": 2)")));
  EXPECT_NE(text(), first);
}

TEST_F(MakeTest, RefusesFoldersThatHoldOtherThings) {
  const auto run = finished_run("ann");
  write_file(folder_ / "notes.txt", "mine");
  EXPECT_THAT(complaint({run}, members()), AllOf(HasSubstr("holds other things"), HasSubstr("notes.txt")));
  fs::remove(folder_ / "notes.txt");
  write_file(folder_ / "clips" / "mine.avi", "mine");
  EXPECT_THAT(complaint({run}, members()), AllOf(HasSubstr("holds other things"), HasSubstr("mine.avi")));
  fs::remove(folder_ / "clips" / "mine.avi");
  write_file(folder_ / "clips" / "left.mp4", "of a making that was killed");
  ASSERT_TRUE(make({run}, members()));
  EXPECT_FALSE(fs::exists(folder_ / "clips" / "left.mp4"));
  EXPECT_THAT(complaint({run}, members()), HasSubstr("holds a study already"));
  write_file(folder_ / "answers.db", "");
  EXPECT_THAT(complaint({run}, members()), HasSubstr("holds answers to a study already"));
}

TEST_F(MakeTest, LeavesNothingWhereItFails) {
  const auto run = finished_run("ann", {"fails=a2"}, true);
  EXPECT_THAT(complaint({run}, members()), AllOf(HasSubstr("ann"), HasSubstr("1 failed"), HasSubstr("this one fails")));
  const auto sound = finished_run("bob", {"same=true"});
  EXPECT_THAT(complaint({sound}, members()), AllOf(HasSubstr("study.json:"), HasSubstr("make 1 different")));
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(MakeTest, SaysWhatIsWrongWithARun) {
  const auto run = finished_run("ann");
  EXPECT_THAT(complaint({files_.path()}, members()), HasSubstr("is not the folder of a run"));
  EXPECT_THAT(complaint({run, run}, members()), HasSubstr("the same run twice"));
  EXPECT_THAT(complaint({finished_run("none", {"held_out=0"})}, members()), HasSubstr("no sequences held out"));
  write_file(run / "run.json", R"({ "status": "running" })");
  EXPECT_THAT(complaint({run}, members()),
              AllOf(HasSubstr("has not finished"), HasSubstr("still runs, or was killed")));
  write_file(run / "run.json", R"({ "status": "finished" )");
  EXPECT_THAT(complaint({run}, members()), HasSubstr("is damaged"));
}

TEST_F(MakeTest, SaysWhichPortsAreNotThere) {
  const auto run = finished_run("ann");
  const std::string base = members();
  const auto with = [&](const std::string& from, const std::string& to) {
    auto changed = base;
    return changed.replace(changed.find(from), from.size(), to);
  };
  EXPECT_THAT(complaint({run}, with("\"move.recorded\"", "\"mve.recorded\"")),
              AllOf(HasSubstr("s.json:"), HasSubstr("has no node \"mve\""), HasSubstr("did you mean \"move\"")));
  EXPECT_THAT(complaint({run}, with("\"move.recorded\"", "\"move.heard\"")), HasSubstr("no port \"move.heard\""));
  EXPECT_THAT(complaint({run}, with("\"move.recorded\"", "\"parts.audio\"")), HasSubstr("gives Audio"));
}

TEST_F(MakeTest, NamesSpeakersApart) {
  const auto a = finished_run("x/run"), b = finished_run("y/run");
  EXPECT_THAT(complaint({a, b}, members()), HasSubstr("several runs are called \"run\": name each in \"speakers\""));
  EXPECT_THAT(complaint({a, b}, members(R"(, "speakers": ["Ann"])")), HasSubstr("names 1, but there are 2 runs"));
  ASSERT_TRUE(make({a, b}, members(R"(, "speakers": ["Ann", "Bob"])"))) << diagnostics_.str();
  std::set<std::string> speakers;
  const auto study = read_study(folder_);
  for (const auto& clip : study.tests[0].clips) speakers.insert(clip.speaker);
  EXPECT_EQ(speakers, (std::set<std::string>{"Ann", "Bob"}));
}

}  // namespace
}  // namespace talkgraph::study
