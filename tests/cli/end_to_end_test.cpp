#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/run.h"
#include "cli/speak.h"
#include "nodes/all_nodes.h"
#include "nodes/media/audio_file.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/media/video_file.h"
#include "nodes/voice/voice.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

// The main job, small: a speaker of ten sentences is learnt, two more are
// synthesised, and the model then speaks a sentence that it has never heard.
TEST(EndToEnd, LearnsAFaceAndSpeaksWithIt) {
#ifndef TALKGRAPH_ESPEAK
  GTEST_SKIP() << "built without espeak-ng, which the built-in speaker needs";
#endif
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg, which writes the clips";
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "run";
  const Registry registry = all_nodes();
  RunCommand run;
  run.sets = {"sentences=12", "held_out=2"};
  run.folder = folder;
  run.progress = ProgressStyle::quiet;
  ASSERT_EQ(run_file(test::source("/pipelines/demo.json"), run, registry), success);
  const Json metrics = Json::parse(temporary.read("run/metrics.json"));
  const auto& rows = metrics["scores"]["rows"];
  ASSERT_TRUE(rows.contains("SSGPDM"));
  EXPECT_EQ(rows["SSGPDM"]["sequences"], 2);
  EXPECT_LT(rows["SSGPDM"]["amse_share"], rows["training mean"]["amse_share"]);
  for (const char* file : {"report.html", "scores.csv", "run.json", "graph.resolved.json", "log.txt", "model.h5"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;

  SpeakCommand words;
  words.model = (folder / "model.h5").string();
  words.text = "Bob may buy a blue boat.";
  words.output = folder / "said.mp4";
  words.visemes = folder / "said.tsv";
  words.progress = ProgressStyle::quiet;
  ASSERT_EQ(speak(words, registry), success);
  const Video clip = open_video((folder / "said.mp4").string());
  EXPECT_GT(clip.source->frames(), 25);
  EXPECT_EQ(clip.source->frames(), static_cast<std::int64_t>(clip.read_all().size()));
  EXPECT_NE(temporary.read("run/said.tsv").find("\tA\n"), std::string::npos) << "lips close on b and m";

  write_audio(temporary.path() / "a.wav", talkgraph::speak(words.text, {}).audio);
  SpeakCommand several = words;
  several.text.clear();
  several.files = {(temporary.path() / "a.wav").string(), temporary.write("b.wav", "no sound")};
  several.transcripts = {temporary.write("a.txt", words.text), "nothing"};
  several.output = temporary.path() / "clips";
  several.visemes.clear();
  EXPECT_EQ(speak(several, registry), failed);
  EXPECT_EQ(open_video((several.output / "a.mp4").string()).source->frames(), clip.source->frames());
  EXPECT_FALSE(fs::exists(several.output / "b.mp4"));
}

// Recordings without pictures: one dimension of the visual track follows the phones, the other is the same held back
// by a frame. What is written has the names of what was read.
TEST(EndToEnd, LearnsReadyMadeVisualTracks) {
#ifndef TALKGRAPH_ESPEAK
  GTEST_SKIP() << "built without espeak-ng, which speaks here";
#endif
  const test::TemporaryFolder temporary;
  const std::vector<std::string> texts = {"Bob may buy a blue boat.",  "My mother bought a map.",
                                          "A boy may pay me more.",    "Buy me a blue map, Bob.",
                                          "Your boat may be my boat.", "More boys bought blue boats.",
                                          "My boy may buy more maps.", "Pay Bob, and buy a map."};
  Json clips = Json::array();
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string id = "s" + std::to_string(i);
    const Utterance said = talkgraph::speak(texts[i], {});
    write_audio(temporary.path() / (id + ".wav"), said.audio);
    std::string csv = "jaw,late\n";
    const auto open_at = [&](double time) {
      for (const auto& p : said.phones.phones)
        if (time >= p.start && time < p.end)
          return p.label == "sil" || p.label == "b" || p.label == "m" || p.label == "p" ? 0 : 1;
      return 0;
    };
    for (int t = 0; t < said.audio.seconds() * 50; ++t)
      csv += std::to_string(open_at((t + 0.5) / 50)) + "," + std::to_string(open_at((t - 0.5) / 50)) + "\n";
    temporary.write(id + ".csv", csv);
    clips.push_back(
        {{"id", id}, {"audio", id + ".wav"}, {"transcript", texts[i]}, {"split", i < 6 ? "train" : "test"}});
    if (i < 7) clips.back()["visual"] = {{"file", id + ".csv"}, {"rate", 50}};
  }
  RunCommand run;
  run.sets = {"fps=50", "manifest=" + temporary.write("manifest.json", Json{{"clips", clips}}.dump())};
  run.folder = temporary.path() / "run";
  run.progress = ProgressStyle::quiet;
  ASSERT_EQ(run_file(test::source("/pipelines/own-tracks.json"), run, all_nodes()), success);
  const Json rows = Json::parse(temporary.read("run/metrics.json"))["scores"]["rows"];
  EXPECT_EQ(rows["SSGPDM"]["sequences"], 1);
  EXPECT_LT(rows["SSGPDM"]["amse_share"], 0.7);
  EXPECT_EQ(temporary.read("run/tracks/s6.csv").substr(0, 9), "jaw,late\n");
  EXPECT_EQ(temporary.read("run/tracks/s7.csv").substr(0, 6), "d0,d1\n")
      << "no recorded track: it is spoken, not scored";
}

TEST(EndToEnd, RefusesAFolderThatCannotBeWritten) {
  const test::TemporaryFolder temporary;
  RunCommand run;
  run.folder = temporary.write("in_the_way", "x") + "/run";
  run.progress = ProgressStyle::quiet;
  EXPECT_THROW(run_file(test::source("/pipelines/demo.json"), run, all_nodes()), std::runtime_error);
}

TEST(EndToEnd, SaysWhatIsWrongWithAGraph) {
  RunCommand run;
  run.progress = ProgressStyle::quiet;
  EXPECT_EQ(run_file("nowhere.json", run, all_nodes()), usage);
  run.sets = {"sentences=0"};
  EXPECT_EQ(run_file(test::source("/pipelines/demo.json"), run, all_nodes()), usage);
}

}  // namespace
}  // namespace talkgraph::cli
