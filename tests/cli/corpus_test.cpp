#include "cli/corpus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "cli/samples.h"
#include "nodes/all_nodes.h"
#include "nodes/media/ffmpeg.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// A clip whose mouth is `late` frames behind the sound.
ClipFindings clip(const std::string& id, int late, const std::string& split = "train") {
  ClipFindings c{id, split, {}, {}};
  c.findings.values = {{"sound_rate", 44100}, {"sound_seconds", 3},   {"sound_peak", 0.5}, {"fps", 25},
                       {"frames", 75},        {"picture_seconds", 3}, {"damaged", 0},      {"transcript", 1},
                       {"words", 0},          {"phones", 0},          {"landmarks", 1},    {"landmark_frames", 75},
                       {"landmark_gaps", 0},  {"red", 150},           {"visual", 0}};
  for (int lag = -8; lag <= 8; ++lag)
    c.findings.values["lag " + std::to_string(lag)] = std::max(0.0, 0.8 - 0.05 * (lag - late) * (lag - late));
  c.phones.values = {{"aa", 3}, {"b", 2}};
  return c;
}

TEST(CorpusReport, AddsClipsUp) {
  const Json report = corpus_report({clip("a", 1), clip("b", 2, "test"), clip("c", 1)});
  EXPECT_EQ(report["splits"], (Json{{"train", 2}, {"test", 1}}));
  EXPECT_EQ(report["sound_seconds"], 9);
  EXPECT_EQ(report["phones"]["aa"], 9);
  EXPECT_EQ(report["phones"]["zh"], 0);
  EXPECT_EQ(report["phones"].size(), 39u) << "CMU";
  EXPECT_EQ(report["missing_phones"].size(), 37u);
  EXPECT_EQ(report["lacking"]["words"].size(), 3u);
  EXPECT_TRUE(report["lacking"]["transcript"].empty());
  EXPECT_NEAR(report["offset"]["frames"], 4.0 / 3, 1e-9);
  EXPECT_NEAR(report["offset"]["milliseconds"], 160.0 / 3, 1e-6);
  for (const auto& c : report["clips"]) EXPECT_TRUE(c["problems"].empty()) << c;
  EXPECT_THAT(report_text(report), HasSubstr("nothing is wrong with any clip"));
  EXPECT_THAT(report_text(report), HasSubstr("+1.3 frames, +53 ms: the mouth is late"));
}

TEST(CorpusReport, TellsWhatIsWrongWithAClip) {
  auto damaged = clip("damaged", 0), silent = clip("silent", 0), fast = clip("fast", 0), marks = clip("marks", 0),
       late = clip("late", 6);
  damaged.findings.values["damaged"] = 2;
  damaged.findings.values["damaged_from"] = 10;
  damaged.findings.values["damaged_to"] = 12;
  silent.findings.values["sound_peak"] = 0;
  silent.findings.values["sound_seconds"] = 2;
  fast.findings.values["fps"] = 50;
  marks.findings.values["landmark_frames"] = 70;
  marks.findings.values["landmark_gaps"] = 3;
  marks.findings.values["transcript"] = 0;
  marks.findings.values["red"] = 220;
  const Json report = corpus_report({clip("a", 0), clip("b", 0), damaged, silent, fast, marks, late});
  const std::string text = report_text(report);
  for (const char* part :
       {"damaged: 2 of 75 frames are damaged (10 to 12)", "silent: the sound is silent",
        "silent: the sound lasts 2.00 s, the picture 3.00 s", "fast: 50 frames a second, most clips have 25",
        "marks: landmarks of 70 frames, the picture has 75", "marks: 3 of 70 frames lack landmarks",
        "marks: the picture's red is 220, of most clips 150",
        "late: the picture seems to be 6 frames late against the other clips", "6 of 7 clips, not marks",
        "frames a second: 25 (6), 50 (1)"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(CorpusReport, KnowsBeepPhonesAndSoundWithoutPictures) {
  ClipFindings sound{
      "s", "train", {{{"sound_seconds", 2.0}, {"sound_peak", 0.1}, {"sound_rate", 8000.0}}}, {{{"oh", 1.0}}}};
  const Json report = corpus_report({sound});
  EXPECT_EQ(report["phones"].size(), 44u);
  EXPECT_TRUE(report["offset"].is_null());
  EXPECT_THAT(report_text(report), HasSubstr("picture: not known"));
  EXPECT_THAT(report_text(report), HasSubstr("nothing is wrong"));
  EXPECT_EQ(report_text(corpus_report({})), "no clip could be read\n");
}

TEST(CorpusReport, ClaimsNoOffsetThatChanceExplains) {
  const auto offset = [](double frames, double height, int clips) {
    std::vector<ClipFindings> all(static_cast<std::size_t>(clips), clip("a", 1));
    for (auto& c : all) {
      c.findings.values["frames"] = frames;
      for (auto& [name, v] : c.findings.values)
        if (name.starts_with("lag ")) v *= height / 0.8;
    }
    return corpus_report(all)["offset"];
  };
  EXPECT_NEAR(offset(75, 0.8, 3)["frames"], 1, 1e-9);
  EXPECT_TRUE(offset(9, 1, 30).is_null()) << "a lag of six leaves three frames";
  EXPECT_TRUE(offset(75, 0.8, 1).is_null());
  EXPECT_TRUE(offset(75, 0.1, 3).is_null());
  EXPECT_NEAR(offset(75, 0.1, 100)["frames"], 1, 1e-9) << "3 / sqrt(7500 / 3) = 0.06";
}

TEST(CorpusReport, TellsWhatCannotBeReadAndWhatIsAnnotated) {
  auto bad = clip("bad", 0), annotated = clip("annotated", 0);
  bad.faults = {"bad.lab:2: the interval ends before it starts"};
  annotated.findings.values["landmark_gaps"] = 73;
  annotated.annotated = true;
  const Json report = corpus_report({bad, annotated});
  EXPECT_EQ(report["unread"], Json({"bad"}));
  const std::string text = report_text(report);
  EXPECT_THAT(text, HasSubstr("look at:\n  bad: bad.lab:2: the interval ends before it starts\n"));
  EXPECT_THAT(text, Not(HasSubstr("lack landmarks")));
  EXPECT_THAT(text, HasSubstr("landmarks    all clips; in 1 of some frames\n"));
}

std::string output_of(const std::function<int()>& call, int expected) {
  testing::internal::CaptureStdout();
  const int code = call();
  const std::string out = testing::internal::GetCapturedStdout();
  EXPECT_EQ(code, expected) << out;
  return out;
}

TEST(Corpus, IsListedAndLookedOver) {
#ifndef TALKGRAPH_ESPEAK
  GTEST_SKIP() << "built without espeak-ng, which the built-in speaker needs";
#endif
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg, which writes the clips";
  const test::TemporaryFolder folder;
  const Registry registry = all_nodes();
  RunCommand run;
  run.folder = folder.path() / "samples";
  run.progress = ProgressStyle::quiet;
  output_of([&] { return write_samples(run, registry); }, success);

  CorpusCommand command;
  command.source = folder.file("samples/clips");
  folder.write("samples/clips/s001.txt", "hello");
  EXPECT_THAT(output_of([&] { return new_corpus(command); }, success), HasSubstr("clips/manifest.json"));
  EXPECT_THROW(new_corpus(command), std::invalid_argument) << "what is there is not written over";
  command.overwrite = true;
  output_of([&] { return new_corpus(command); }, success);

  run.folder = ".";
  command.source = folder.file("samples/clips/manifest.json");
  const std::string text = output_of([&] { return check_corpus(command, run, registry); }, success);
  EXPECT_THAT(text, HasSubstr("2 clips (2 train)"));
  EXPECT_THAT(text, HasSubstr("phones: 4 of 39 occur"));
  EXPECT_THAT(text, HasSubstr("transcript   1 of 2 clips, not s002"));
  command.json = true;
  const Json report = Json::parse(output_of([&] { return check_corpus(command, run, registry); }, success));
  EXPECT_EQ(report["phones"]["hh"], 1);
  EXPECT_EQ(report["clips"][0]["findings"]["fps"], 25);
  EXPECT_TRUE(report["offset"].is_null()) << "five seconds are too little";

  command.source = folder.file("samples/grid");
  EXPECT_THAT(output_of([&] { return check_corpus(command, run, registry); }, success), HasSubstr("\"words\""));
  fs::resize_file(folder.path() / "samples/clips/s002.mp4", 100);
  command.source = folder.file("samples/clips/manifest.json");
  command.json = false;
  const auto checked = [&](int code) { return output_of([&] { return check_corpus(command, run, registry); }, code); };
  EXPECT_THAT(checked(failed), AllOf(HasSubstr("2 clips (2 train)"), HasSubstr("look at:\n  s002: "),
                                     HasSubstr("transcript   1 of 2 clips, not s002")));
  folder.write("samples/clips/s001.lab", "0 1000 aa\n1000 x b\n");
  folder.write("samples/clips/s001.csv", "x0,y1\n1,2\n");
  folder.write("samples/clips/bad.json", R"({"clips": [
    {"id": "s001", "video": "s001.mp4", "phones": "s001.lab", "landmarks": "s001.csv", "transcript": "hello"}]})");
  command.source = folder.file("samples/clips/bad.json");
  EXPECT_THAT(checked(failed), AllOf(HasSubstr("1 clips (1 train), 3 s of sound"),
                                     HasSubstr("s001: " + folder.file("samples/clips/s001.lab:2")),
                                     HasSubstr("it has no \"y0\", but \"y1\""), HasSubstr("phones: 4 of 39 occur")));
  folder.write("none.json", R"({"clips": []})");
  command.source = folder.file("none.json");
  EXPECT_EQ(checked(failed), "no clip could be read\n");
  fs::remove(folder.path() / "samples/grid/align/s001.align");
  command.source = folder.file("samples/grid");
  EXPECT_THAT(checked(failed), AllOf(HasSubstr("2 clips"), HasSubstr("s001.align: is missing")));
}

TEST(Corpus, SaysWhatIsNotThere) {
  CorpusCommand command;
  command.source = "/nowhere/manifest.json";
  EXPECT_THROW(check_corpus(command, {}, all_nodes()), std::invalid_argument);
  const test::TemporaryFolder videos;
  videos.write("a.mp4", "");
  command.source = videos.path();
  const auto error = [&] {
    try {
      check_corpus(command, {}, all_nodes());
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(error(), HasSubstr("talkgraph corpus new " + videos.path().string()));
  videos.write("manifest.json", "{\n\"clip\": []}");
  EXPECT_THAT(error(), HasSubstr("its manifest is " + videos.file("manifest.json")));
  command.source = videos.file("manifest.json");
  EXPECT_THAT(error(), HasSubstr("manifest.json:2:1: error: unknown member \"clip\""));
  command.source = videos.write("caf\xe9/manifest.json", "{}");
  EXPECT_THAT(error(), HasSubstr("is not UTF-8; rename it"));
  command.source = "/nowhere";
  EXPECT_THROW(new_corpus(command), std::runtime_error);
  const test::TemporaryFolder folder;
  folder.write("clips/a.mp4", "");
  command.source = folder.file("clips");
  command.output = folder.file("manifest.json");
  EXPECT_THROW(new_corpus(command), std::invalid_argument) << "names of files count from the manifest's folder";
  command.output.clear();
  for (const char* rate : {"0", "-5", "fast"}) {
    command.rate = rate;
    EXPECT_THROW(new_corpus(command), std::invalid_argument) << rate;
  }
  EXPECT_FALSE(fs::exists(folder.path() / "clips/manifest.json"));
}

}  // namespace
}  // namespace talkgraph::cli
