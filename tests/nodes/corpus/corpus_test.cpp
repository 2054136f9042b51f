#include <fmt/format.h>

#include <map>
#include <opencv2/imgcodecs.hpp>

#include "nodes/corpus/files.h"
#include "nodes/corpus/grid.h"
#include "nodes/corpus/manifest.h"
#include "nodes/corpus/parts.h"
#include "nodes/corpus/pick.h"
#include "nodes/corpus/pick_track.h"
#include "nodes/corpus/register.h"
#include "nodes/corpus/select.h"
#include "nodes/corpus/splits.h"
#include "nodes/corpus/thin.h"
#include "nodes/media/audio_file.h"
#include "nodes/media/check_video.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/media/register.h"
#include "nodes/types/scheme.h"
#include "tests/nodes/media/media_test.h"
#include "tests/source_folder.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

std::vector<Recording> all(Stream<Recording> stream) {
  std::vector<Recording> recordings;
  while (auto item = stream.next()) {
    EXPECT_EQ(item->key, item->value.id);
    recordings.push_back(item->value);
  }
  return recordings;
}

std::vector<std::string> ids(const std::vector<Recording>& recordings) {
  std::vector<std::string> names;
  for (const auto& r : recordings) names.push_back(r.id + ":" + r.split);
  return names;
}

class GridTest : public MediaTest {
 protected:
  GridTest() {
    for (const char* sub : {"video", "align", "landmarks"}) std::filesystem::create_directories(folder_ / sub);
    write("split.json", R"({"train": ["a", "b"], "test": ["c"]})");
    for (const std::string id : {"a", "b", "c"}) {
      write("video/" + id + ".mpg", "not opened");
      write("align/" + id + ".align", "0 10000 sil\n10000 20000 bin\n20000 25000 blue\n");
      std::string row = "0";
      for (int i = 0; i < 136; ++i) row += "," + std::to_string(i);
      std::string head = "frame";
      for (int i = 0; i < 68; ++i) head += ",x" + std::to_string(i) + ",y" + std::to_string(i);
      write("landmarks/" + id + ".csv", head + "\n" + row + "\n");
    }
    node_.folder = {folder_.string()};
  }
  Grid node_;
};

TEST_F(GridTest, ReadsTheClipsOfEverySplit) {
  const auto clips = all(node_());
  EXPECT_THAT(ids(clips), ElementsAre("a:train", "b:train", "c:test"));
  EXPECT_EQ(clips[1].transcript->text, "bin blue");
  EXPECT_EQ(clips[1].words->words.size(), 3u);
  EXPECT_EQ(clips[1].landmarks->scheme, "ibug68");
  EXPECT_EQ(clips[1].landmarks->frames.at(0)(67, 1), 135);
  EXPECT_FALSE(clips[1].phones);
  EXPECT_TRUE(clips[1].audio && clips[1].video);
  EXPECT_EQ(node_().size(), 3u);
}

TEST_F(GridTest, LimitCountsInEverySplit) {
  node_.limit = 1;
  EXPECT_THAT(ids(all(node_())), ElementsAre("a:train", "c:test"));
}

TEST_F(GridTest, WithoutLandmarks) {
  std::filesystem::remove_all(folder_ / "landmarks");
  EXPECT_FALSE(all(node_())[0].landmarks);
}

TEST_F(GridTest, Errors) {
  write("align/b.align", "0 1\n");
  EXPECT_THAT(error_of([&] { all(node_()); }), HasSubstr("b.align:1: "));
  std::filesystem::remove(path("video/a.mpg"));
  std::filesystem::remove(path("landmarks/c.csv"));
  EXPECT_THAT(error_of([&] { node_(); }), AllOf(HasSubstr("2 files"), HasSubstr("video/a.mpg"), HasSubstr("c.csv")));
  write("split.json", "{\"train\": [\"a\", 3],\n \"test\": [\"a\"]}");
  EXPECT_THAT(error_of([&] { node_(); }), AllOf(HasSubstr("split.json:1:17: error: the name"),
                                                HasSubstr("split.json:2:11: error: the clip \"a\"")));
  write("split.json", "{");
  EXPECT_THAT(error_of([&] { node_(); }), HasSubstr("split.json:1:"));
  std::filesystem::remove(path("split.json"));
  EXPECT_THAT(error_of([&] { node_(); }), HasSubstr("split.json: is missing"));
  node_.folder = {path("none")};
  EXPECT_THAT(error_of([&] { node_(); }), HasSubstr("there is no such folder"));
}

TEST(Grid, RealRecordings) {
  const std::string folder = test::source("/../shared/data/grid-s1");
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << ", recordings of GRID, is not there";
  Grid node;
  node.folder = {folder};
  const auto clips = all(node());
  std::map<std::string, int> count;
  for (const auto& clip : clips) ++count[clip.split];
  EXPECT_EQ(count, (std::map<std::string, int>{{"train", 198}, {"validation", 30}, {"test", 30}, {"damaged", 2}}));
  Context context;
  const auto parts = Parts{}(clips.at(0), context);
  EXPECT_EQ(parts.audio.rate, 44100);
  EXPECT_NEAR(parts.audio.seconds(), 2.98, 0.03);
  EXPECT_EQ(parts.video->source->frames(), 75);
  EXPECT_EQ(parts.video->source->rate(), Rational(25));
  EXPECT_EQ(parts.video->source->size(), cv::Size(360, 288));
  EXPECT_EQ(parts.landmarks->frames.size(), 75u);
  EXPECT_TRUE(CheckVideo{}(*parts.video, context).damaged.empty());
  EXPECT_EQ(CheckVideo{}(*Parts{}(clips.back(), context).video, context).damaged.size(), 12u);
}

class ManifestTest : public MediaTest {
 protected:
  Manifest node(const std::string& text) {
    Manifest manifest;
    manifest.file = {write("m.json", text)};
    return manifest;
  }
};

TEST_F(ManifestTest, EverythingThatAClipMayHave) {
  write_audio(path("a.wav"), tone(0.2, 16000));
  std::filesystem::create_directories(folder_ / "frames");
  for (const int n : {0, 1, 2}) cv::imwrite(path("frames/" + std::to_string(n) + ".png"), test_picture(n));
  write("a.csv", "jaw,lips\n1,2\n3,4\n5,6\n");
  write("a.lab", "0 1000000 AA1\n");
  write("a.align", "0 2500 sil\n2500 5000 Ah\n");
  write("a.txt", "Ah, yes.");
  write("p.csv", "x0,y0,x1,y1,x2,y2\n1,2,3,4,5,6\n3,4,5,6,7,8\n5,6,7,8,9,9\n");
  write("tiny.json", "{\"name\": \"tiny\",\n\"mean\": [[0, 0], [2, 0], [1, 3]]}\n");
  const auto clips = all(node(R"({"rate": "30000/1001", "clips": [
    {"id": "one", "video": "frames", "audio": "a.wav", "phones": "a.lab", "words": "a.align", "transcript": "a.txt",
     "landmarks": {"file": "p.csv", "scheme": "tiny.json"}, "split": "test", "rate": 15},
    {"id": "two", "audio": "a.wav", "visual": {"file": "a.csv", "rate": 20}, "words": "a.align"},
    {"id": "three", "audio": "a.wav", "transcript": "hello there", "visual": {"file": "a.csv"}}]})")());
  EXPECT_THAT(ids(clips), ElementsAre("one:test", "two:train", "three:train"));
  const Recording& one = clips[0];
  EXPECT_EQ(one.audio().samples.size(), 3200);
  EXPECT_EQ(one.video().source->frames(), 3);
  EXPECT_EQ(one.video().source->rate(), Rational(15));
  EXPECT_EQ(one.phones->phones.at(0).label, "aa");
  EXPECT_EQ(one.transcript->text, "Ah, yes.");
  EXPECT_EQ(find_scheme(one.landmarks->scheme)->name, "tiny");
  EXPECT_EQ(one.landmarks->rate, Rational(15));
  EXPECT_FALSE(one.visual);
  EXPECT_FALSE(clips[1].video);
  EXPECT_EQ(clips[1].transcript->text, "ah");
  EXPECT_EQ(clips[1].visual->values, (Eigen::MatrixXd(3, 2) << 1, 2, 3, 4, 5, 6).finished());
  EXPECT_EQ(clips[1].visual->rate, Rational(20));
  EXPECT_EQ(clips[1].visual->start, 0.025);
  EXPECT_THAT(clips[1].visual->names, ElementsAre("jaw", "lips"));
  EXPECT_EQ(clips[2].visual->rate, Rational(30000, 1001));
  EXPECT_EQ(clips[2].transcript->text, "hello there");
}

TEST_F(ManifestTest, AllThatIsWrongIsToldInOneGo) {
  write_audio(path("a.wav"), tone(0.1, 8000));
  const std::string error = error_of([&] {
    node(R"({"clips": [
 {"id": "x", "audio": "none.wav"},
 {"id": "x", "audio": "a.wav"},
 {"audio": "a.wav", "transcrip": "hello"},
 {"id": "y"},
 {"id": "z", "audio": 3, "visual": {"dataset": "d"}},
 {"id": "w", "audio": "a.wav", "phones": "a.wav", "rate": -1},
 7
]})")();
  });
  EXPECT_THAT(error, HasSubstr("m.json:2:23: error: there is no file"));
  EXPECT_THAT(error, HasSubstr("m.json:3:9: error: the clip in line 2 has the id \"x\" already"));
  EXPECT_THAT(error, HasSubstr("m.json:4:2: error: a clip needs an \"id\""));
  EXPECT_THAT(error, HasSubstr("unknown member \"transcrip\" (did you mean \"transcript\"?)"));
  EXPECT_THAT(error, HasSubstr("m.json:5:2: error: a clip needs sound"));
  EXPECT_THAT(error, HasSubstr("\"audio\": a text is expected, got a number"));
  EXPECT_THAT(error, HasSubstr("\"visual\" needs a \"file\""));
  EXPECT_THAT(error, HasSubstr("\"visual\" needs a \"rate\""));
  EXPECT_THAT(error, HasSubstr("\"phones\" must end in one of .lab, .textgrid, .align"));
  EXPECT_THAT(error, HasSubstr("\"rate\": must be positive"));
  EXPECT_THAT(error, HasSubstr("m.json:8:2: error: a clip is an object"));
  EXPECT_THAT(error, Not(EndsWith("\n")));
}

TEST_F(ManifestTest, LandmarksOfSomeFramesInAFolder) {
  write_audio(path("a.wav"), tone(0.2, 16000));
  for (const int n : {0, 1, 2}) {
    std::filesystem::create_directories(folder_ / "frames");
    cv::imwrite(path("frames/" + std::to_string(n) + ".png"), test_picture(n));
  }
  write("tiny.json", R"({"name": "tiny", "mean": [[0, 0], [2, 0], [1, 3]]})");
  write("own.csv", "x0,y0,x1,y1,x2,y2\n1,2,3,4,5,6\n1,2,3,4,5,6\n1,2,3,4,5,6\n");
  write("marked/one/000001.pts", "{\n5 6\n7 8\n9 9\n}\n");
  write("marked/three/000001.pts", "{\n5 6\n7 8\n9 9\n}\n");
  write("marked/four/000001.draft", "{\n5 6\n7 8\n9 9\n}\n");
  const auto clips = all(node(R"({"rate": 25, "landmarks": {"folder": "x/../marked/", "scheme": "tiny.json"}, "clips": [
    {"id": "one", "video": "frames", "audio": "a.wav"}, {"id": "two", "video": "frames", "audio": "a.wav"},
    {"id": "three", "video": "frames", "audio": "a.wav", "landmarks": "own.csv"},
    {"id": "four", "video": "frames", "audio": "a.wav"}, {"id": "five", "audio": "a.wav"}]})")());
  ASSERT_TRUE(clips[0].landmarks);
  EXPECT_EQ(find_scheme(clips[0].landmarks->scheme)->name, "tiny");
  ASSERT_EQ(clips[0].landmarks->frames.size(), 3u);
  EXPECT_EQ(clips[0].landmarks->frames[1](2, 0), 8);
  EXPECT_TRUE(clips[0].landmarks->frames[2].hasNaN());
  EXPECT_FALSE(clips[1].landmarks) << "nothing is annotated of it";
  EXPECT_EQ(clips[2].landmarks->frames[0](0, 0), 1) << "a clip's own landmarks count";
  EXPECT_FALSE(clips[3].landmarks) << "a draft is not used";
  EXPECT_FALSE(clips[4].landmarks);
}

TEST_F(ManifestTest, WhatIsWrongWithLandmarksIsToldWithItsPlace) {
  write_audio(path("a.wav"), tone(0.1, 8000));
  write("bad.json", "{\"name\": \"bad\"}");
  const auto error = [&](const std::string& beside, const std::string& clip) {
    return error_of(
        [&] { node(fmt::format("{{{} \"clips\": [\n{{\"id\": \"x\", \"audio\": \"a.wav\"{}}}]}}", beside, clip))(); });
  };
  EXPECT_THAT(error("", R"(, "landmarks": {"file": "none.csv", "scheme": "ibug"})"),
              AllOf(HasSubstr("m.json:2:53: error: there is no file or folder"),
                    HasSubstr("no point scheme \"ibug\" (did you mean \"ibug68\"?)")));
  EXPECT_THAT(error("", R"(, "landmarks": {"scheme": "{\"name\": \"x\"}"})"),
              AllOf(HasSubstr("m.json:2:55: error: point scheme:1:1: "), HasSubstr("\"mean\" is missing")));
  EXPECT_THAT(
      error("", R"(, "landmarks": {"file": "a.wav", "sparse": 1})"),
      AllOf(HasSubstr("must end in one of .csv, .h5, .hdf5"), HasSubstr("\"sparse\": true or false is expected")));
  EXPECT_THAT(error(R"("landmarks": {"scheme": "bad.json"},)", ""), HasSubstr("\"landmarks\" needs a \"folder\""));
  EXPECT_THAT(error(R"("landmarks": {"folder": "f", "scheme": "bad.json"},)", ""),
              HasSubstr("bad.json:1:1: error: \"mean\" is missing"));
  EXPECT_THAT(error(R"("landmarks": {"folder": "f", "scheme": "none.json"},)", ""), HasSubstr("there is no file"));
  EXPECT_THAT(error(R"("landmarks": "f",)", ""), HasSubstr("an object with \"folder\" and \"scheme\" is expected"));
}

TEST_F(ManifestTest, IdsNameFiles) {
  write_audio(path("a.wav"), tone(0.1, 8000));
  for (const char* id : {"", "../x", ".hidden", "a/b", "two\\nlines"})
    EXPECT_THAT(error_of([&] { node(fmt::format(R"({{"clips": [{{"id": "{}", "audio": "a.wav"}}]}})", id))(); }),
                AllOf(HasSubstr("m.json:1:"), HasSubstr("\"id\"")))
        << id;
  EXPECT_EQ(all(node(R"({"clips": [{"id": "ä b-1.2", "audio": "a.wav"}]})")()).size(), 1u);
}

TEST_F(ManifestTest, LabelsOfAllClipsAreReadBeforeAnythingElse) {
  write_audio(path("a.wav"), tone(0.1, 8000));
  write("a.lab", "0 1000000 Q7\n");
  write("b.align", "0 1\n");
  const std::string error = error_of([&] {
    node(R"({"clips": [{"id": "one", "audio": "a.wav", "phones": "a.lab"},
                       {"id": "two", "audio": "a.wav", "words": "b.align"}]})")();
  });
  EXPECT_THAT(error, HasSubstr("clip \"one\": " + path("a.lab") + ": \"Q7\" at 0.000 s is no CMU or BEEP phone"));
  EXPECT_THAT(error, HasSubstr("clip \"two\": " + path("b.align") + ":1: "));
}

TEST_F(ManifestTest, AnErrorInAFileNamesTheClip) {
  write_audio(path("a.wav"), tone(0.1, 8000));
  write("v.csv", "1,2\n3\n");
  EXPECT_THAT(error_of([&] {
                all(node(R"({"clips": [{"id": "u", "audio": "a.wav", "visual": {"file": "v.csv", "rate": 25}}]})")());
              }),
              HasSubstr("clip \"u\": "));
}

TEST_F(ManifestTest, BadFiles) {
  EXPECT_THAT(error_of([&] { node("{\"clips\": [}")(); }), HasSubstr("m.json:1:"));
  EXPECT_THAT(error_of([&] { node("[]")(); }), HasSubstr("a manifest is an object"));
  EXPECT_THAT(error_of([&] { node("{}")(); }), HasSubstr("needs a list \"clips\""));
  EXPECT_THAT(error_of([&] { node("{\"clips\": 3}")(); }), HasSubstr("a list of clips is expected, got a number"));
  Manifest none;
  none.file = {path("none.json")};
  EXPECT_THAT(error_of([&] { none(); }), HasSubstr("none.json: is missing"));
  EXPECT_TRUE(all(node("{\"clips\": []}")()).empty());
}

using CorpusTest = MediaTest;

TEST_F(CorpusTest, SoundFilesGetUniqueIds) {
  std::filesystem::create_directories(folder_ / "b");
  for (const char* name : {"x.wav", "b/x.wav", "y.wav"}) write_audio(path(name), tone(0.1, 8000));
  SoundFiles node;
  node.files = {{path("x.wav")}, {path("b/x.wav")}, {path("y.wav")}};
  node.transcripts = {"one", "", "three"};
  const auto files = all(node());
  EXPECT_THAT(ids(files), ElementsAre("x:", "x-2:", "y:"));
  EXPECT_EQ(files[0].transcript->text, "one");
  EXPECT_FALSE(files[1].transcript);
  EXPECT_FALSE(files[0].video);
  EXPECT_EQ(files[2].audio().samples.size(), 800);
  node.transcripts.pop_back();
  EXPECT_THROW(node(), std::invalid_argument);
  node.transcripts.clear();
  node.files = {{path("none.wav")}, {path("x.wav")}, {folder_.string()}};
  EXPECT_EQ(error_of([&] { node(); }),
            path("none.wav") + ": there is no such file\n" + folder_.string() + ": is a folder; name its files");
}

TEST(Select, TakesTheSplitsNamed) {
  Recording recording;
  recording.split = "train";
  EXPECT_TRUE(Select{}(recording));
  EXPECT_TRUE((Select{{"test", "train"}}(recording)));
  EXPECT_FALSE((Select{{"test"}}(recording)));
}

TEST(Thin, KeepsRecordingsSpreadOverTheirSplit) {
  Collected<Recording> all;
  for (int i = 0; i < 10; ++i) {
    Recording r;
    r.id = std::to_string(i);
    r.split = i % 5 == 4 ? "test" : "train";
    all.add(r.id, r);
  }
  const auto kept = [&](const Thin& thin) {
    std::string ids;
    auto stream = thin(all);
    while (const auto item = stream.next()) ids += item->value.id;
    return ids;
  };
  EXPECT_EQ(kept({{"train"}, 4}), "134689");
  EXPECT_EQ(kept({{"train"}, 8}), "0123456789");
  EXPECT_EQ(kept({{"train"}, 100}), "0123456789");
  EXPECT_EQ(kept({{"train"}, 1}).size(), 3u);
  EXPECT_EQ(kept({{}, 1}).size(), 2u);
  EXPECT_EQ(kept({{}, 1}), kept({{}, 1}));
  EXPECT_THROW((Thin{{"trian"}, 4})(all), std::runtime_error);
}

TEST(Pick, TakesTheRecordingsNamed) {
  Recording recording;
  recording.id = "b";
  EXPECT_TRUE((Pick{{"a", "b"}}(recording)));
  EXPECT_FALSE((Pick{{"a"}}(recording)));
  EXPECT_FALSE(Pick{}(recording));
}

TEST(PickTrack, TakesTheTracksOfTheRecordingsNamed) {
  Context context;
  context.item = "b";
  Track track;
  track.values = Eigen::MatrixXd::Ones(2, 3);
  const auto picked = PickTrack{{"a", "b"}}(track, context);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->values, track.values);
  EXPECT_FALSE((PickTrack{{"a"}}(track, context)));
}

Collected<Recording> of_splits(const std::vector<std::string>& splits) {
  Collected<Recording> out;
  for (const auto& split : splits) {
    Recording recording;
    recording.split = split;
    out.add(std::to_string(out.size()), recording);
  }
  return out;
}

TEST(Splits, CountsThemInTheirOrder) {
  const Table table = Splits{{"train"}, "test"}(of_splits({"train", "test", "train", "spare"}));
  EXPECT_THAT(table.rows, ElementsAre("train", "test", "spare"));
  EXPECT_EQ(table.cells, (std::vector<std::vector<double>>{{2}, {1}, {1}}));
  EXPECT_TRUE(Splits{}(of_splits({})).rows.empty());
}

TEST(Splits, WhatIsNeededMustHaveRecordings) {
  EXPECT_EQ(
      error_of([] {
        Splits{{"train"}, "validaton"}(of_splits({"train", "validation"}));
      }),
      "no recording belongs to the split \"validaton\" (did you mean \"validation\"?); there are: train, validation");
  EXPECT_THAT(error_of([] {
                Splits{{"train"}, "test"}(of_splits({"test"}));
              }),
              HasSubstr("no recording belongs to the split \"train\""));
  EXPECT_THAT(error_of([] {
                Splits{{"train", "test"}, "test"}(of_splits({"train", "test"}));
              }),
              HasSubstr("the split \"test\" is trained on and scored"));
}

class PartsTest : public testing::Test {
 protected:
  PartsTest() {
    recording_.id = "u";
    recording_.audio = [] { return tone(1, 16000); };
    recording_.video = [] { return test_video(25, 25); };
    context_.on_warning = [this](std::string_view text) { log_ += text; };
  }
  Recording recording_;
  Context context_;
  std::string log_;
};

TEST_F(PartsTest, WhatIsAbsentStaysAbsent) {
  recording_.video = nullptr;
  const auto parts = Parts{}(recording_, context_);
  EXPECT_EQ(parts.audio.samples.size(), 16000);
  EXPECT_FALSE(parts.video || parts.transcript || parts.words || parts.phones || parts.landmarks || parts.visual);
}

TEST_F(PartsTest, LengthsAreCompared) {
  Parts{}(recording_, context_);
  EXPECT_EQ(log_, "");
  recording_.audio = [] { return tone(1.3, 16000); };
  Parts{}(recording_, context_);
  EXPECT_THAT(log_, HasSubstr("u: the sound lasts 1.30 s, the picture 1.00 s"));
  log_.clear();
  recording_.video = nullptr;
  recording_.visual = Track{Eigen::MatrixXd::Zero(10, 2), 25, 0.02, {}};
  Parts{}(recording_, context_);
  EXPECT_THAT(log_, HasSubstr("the visual track 0.40 s"));
}

TEST_F(PartsTest, LandmarksMustBeOfTheVideo) {
  recording_.landmarks = LandmarkTrack{std::vector<Shape>(23, Shape::Zero(3, 2)), 25, ""};
  EXPECT_NO_THROW(Parts{}(recording_, context_));
  recording_.landmarks->frames.pop_back();
  EXPECT_THAT(error_of([&] { Parts{}(recording_, context_); }),
              HasSubstr("has 25 frames, but its landmarks are of 22"));
  recording_.landmarks = LandmarkTrack{std::vector<Shape>(25, Shape::Zero(3, 2)), 30, ""};
  EXPECT_THAT(error_of([&] { Parts{}(recording_, context_); }),
              HasSubstr("25 frames per second, but its landmarks 30"));
}

TEST_F(PartsTest, PicturesHaveTheRateOfTheGraph) {
  Parts parts;
  parts.fps = 25;
  EXPECT_NO_THROW(parts(recording_, context_));
  parts.fps = 30;
  EXPECT_THAT(error_of([&] { parts(recording_, context_); }),
              HasSubstr("has 25 frames per second, this graph works at 30: set its fps to 25"));
  recording_.video = nullptr;
  recording_.visual = Track{Eigen::MatrixXd::Zero(60, 2), 60, 0.5 / 60, {}};
  EXPECT_THAT(error_of([&] { parts(recording_, context_); }), HasSubstr("u: visual track: has 60 frames per second"));
}

TEST_F(PartsTest, LabelsEndWhereTheSoundDoes) {
  recording_.phones = PhoneTrack{{{"aa", 0, 0.9}}};
  recording_.words = WordTrack{{{"ah", 0, 1.2}}};
  EXPECT_NO_THROW(Parts{}(recording_, context_));
  recording_.words->words[0].end = 300;
  EXPECT_THAT(error_of([&] { Parts{}(recording_, context_); }),
              AllOf(HasSubstr("u: its words end at 300 s, its sound at 1.00 s"), HasSubstr("unit")));
  recording_.words.reset();
  recording_.phones->phones[0].end = 9e-5;
  EXPECT_THAT(error_of([&] { Parts{}(recording_, context_); }), HasSubstr("u: its phones end at 9e-05 s"));
}

TEST(Registration, EveryNodeIsThere) {
  Registry registry;
  register_media(registry);
  register_corpus(registry);
  for (const char* name : {"media.video", "media.check_video", "media.resample", "corpus.grid", "corpus.manifest",
                           "corpus.files", "corpus.select", "corpus.splits", "corpus.parts"})
    EXPECT_TRUE(registry.find(name)) << name;
}

}  // namespace
}  // namespace talkgraph
