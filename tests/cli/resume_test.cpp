#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "cli/run.h"
#include "graph/random.h"
#include "nodes/all_nodes.h"
#include "nodes/media/audio_file.h"
#include "runtime/cache.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

constexpr int phones_count = 12, clips = 3, frames = 240;
const char* const phones[phones_count] = {"aa", "b", "ch", "d", "eh", "f", "g", "iy", "k", "l", "m", "n"};

/// Clips of noise with phones of four frames each and a visual track of three dimensions.
void write_corpus(const test::TemporaryFolder& folder) {
  Random random(1);
  std::string manifest;
  for (int clip = 0; clip < clips; ++clip) {
    const std::string id = "s" + std::to_string(clip);
    Audio audio{Eigen::VectorXd::NullaryExpr(frames * 640, [&] { return 0.1 * random.normal(); }), 16000};
    write_audio(folder.path() / (id + ".wav"), audio);
    std::string labels, visual;
    for (int t = 0; t < frames; t += 4)
      labels += std::to_string(t * 400000) + " " + std::to_string((t + 4) * 400000) + " " +
                phones[random.below(phones_count)] + "\n";
    for (int t = 0; t < frames; ++t)
      visual += std::to_string(random.normal()) + "," + std::to_string(random.normal()) + "," +
                std::to_string(random.normal()) + "\n";
    folder.write(id + ".lab", labels);
    folder.write(id + ".csv", visual);
    manifest += std::string(clip ? ",\n" : "") + R"({ "id": ")" + id + R"(", "audio": ")" + id +
                R"(.wav", "phones": ")" + id + R"(.lab", "visual": { "file": ")" + id + R"(.csv", "rate": 25 } })";
  }
  folder.write("manifest.json", "{ \"clips\": [" + manifest + "] }");
}

/// Trains a state a phone, each long enough for a kill to come between.
std::string write_graph(const test::TemporaryFolder& folder) {
  const std::string fragments = test::source("/pipelines/fragments/");
  return folder.write("learn.json", R"({ "nodes": {
    "recordings": { "type": "corpus.manifest", "params": { "file": "manifest.json" } },
    "parts": { "type": "corpus.parts", "in": { "recording": "recordings" } },
    "speech": { "graph": ")" + fragments +
                                        R"(speech.json", "in": { "audio": "parts.audio" } },
    "frames": { "type": "sync.frames", "in": { "audio": "parts.audio" } },
    "label": { "type": "phones.label_frames", "in": { "phones": "parts.phones", "like": "frames" } },
    "learnt": { "graph": ")" + fragments +
                                        R"(learn-phones.json",
      "in": { "labels": "label.labels", "audio": "speech.track", "visual": "parts.visual" } } },
    "outputs": { "states": "learnt.states" } })");
}

/// The program on the graph, in a process of its own.
class Training {
 public:
  Training(const test::TemporaryFolder& folder, const std::string& graph) {
    std::vector<std::string> words = {TALKGRAPH_PROGRAM,
                                      "run",
                                      graph,
                                      "--quiet",
                                      "--threads",
                                      "2",
                                      "--cache",
                                      folder.file("cache"),
                                      "-o",
                                      folder.file("killed"),
                                      "--set",
                                      "nodes.learnt/sgpdm.params.iterations=400",
                                      "--set",
                                      "nodes.learnt/sgpdm.params.prior_deviation=0"};
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (posix_spawn(&pid_, TALKGRAPH_PROGRAM, nullptr, nullptr, arguments.data(), environ) != 0) pid_ = -1;
  }
  bool runs() {
    int status = 0;
    if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) pid_ = -1;
    return pid_ > 0;
  }
  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  ~Training() { kill(); }

 private:
  pid_t pid_ = -1;
};

std::size_t trained_states(const Cache& cache) {
  std::size_t count = 0;
  for (const auto& entry : cache.entries())
    count += !entry.about.is_null() && entry.about["recipe"]["type"] == "latent.sgpdm";
  return count;
}

struct Learnt {
  int calls = 0, loaded = 0;
};
Learnt learn(const test::TemporaryFolder& folder, const std::string& graph, const std::string& cache,
             const std::string& name) {
  RunCommand run;
  run.cached = true;
  run.progress = ProgressStyle::quiet;
  run.cache = folder.path() / cache;
  run.folder = folder.path() / name;
  run.sets = {"nodes.learnt/sgpdm.params.iterations=400", "nodes.learnt/sgpdm.params.prior_deviation=0",
              R"(nodes.kept={ "type": "write.hdf5", "in": { "value": "learnt.states" } })"};
  EXPECT_EQ(run_file(graph, run, all_nodes()), success);
  Learnt learnt;
  const Json report = Json::parse(folder.read(name + "/run.json"));
  for (const auto& node : report["nodes"])
    if (node["type"] == "latent.sgpdm") learnt = {node["calls"], node["loaded"]};
  return learnt;
}

TEST(Resume, AKilledTrainingGoesOnWithTheStatesThatAreLeft) {
  const test::TemporaryFolder folder;
  write_corpus(folder);
  const std::string graph = write_graph(folder);
  const Cache cache(folder.path() / "cache");
  Training training(folder, graph);
  const auto started = std::chrono::steady_clock::now();
  while (training.runs() && trained_states(cache) < 3 &&
         std::chrono::steady_clock::now() - started < std::chrono::seconds(300))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(training.runs()) << "it was not to end before it was killed";
  training.kill();
  const auto kept = static_cast<int>(trained_states(cache));
  ASSERT_GE(kept, 3);
  ASSERT_LT(kept, phones_count);

  const Learnt resumed = learn(folder, graph, "cache", "resumed"), whole = learn(folder, graph, "other", "whole");
  EXPECT_EQ(whole.calls, phones_count);
  EXPECT_EQ(resumed.calls, phones_count - kept) << "only the rest is trained";
  EXPECT_EQ(resumed.loaded, kept);
  EXPECT_EQ(folder.read("resumed/hdf5/kept.h5"), folder.read("whole/hdf5/kept.h5"));
  EXPECT_FALSE(folder.read("whole/hdf5/kept.h5").empty());
}

}  // namespace
}  // namespace talkgraph::cli
