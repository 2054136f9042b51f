#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <thread>

#include "runtime/cache.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

/// Two sentences, their sound as log mel energies, their phones aligned: sources, nodes whose results are kept, sinks.
constexpr const char* graph = R"({
  "nodes": {
    "speaker": { "type": "speaker.builtin", "params": { "sentences": 3, "held_out": 1 } },
    "parts": { "type": "corpus.parts", "in": { "recording": "speaker" } },
    "aligned": { "type": "phones.align", "in": { "audio": "parts.audio", "transcript": "parts.transcript" } },
    "write_labels": { "type": "write.labels", "in": { "phones": "aligned.phones" } },
    "write_sound": { "type": "write.audio", "in": { "audio": "parts.audio" } }
  }
})";

int call(const std::string& command) { return std::system(command.c_str()); }

/// What lies in a run folder, but for what tells of the run itself.
std::map<std::string, std::string> files_of(const test::TemporaryFolder& folder, const std::string& run) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path() / run))
    if (entry.is_regular_file() && entry.path().filename() != "run.json" && entry.path().filename() != "log.txt") {
      const auto name = fs::relative(entry.path(), folder.path() / run).string();
      files[name] = folder.read(run + "/" + name);
    }
  return files;
}

TEST(SideBySide, ProcessesMayShareACache) {
  const test::TemporaryFolder folder;
  const std::string cache = folder.file("cache");
  const std::string run = TALKGRAPH_PROGRAM " run -q '" + folder.write("graph.json", graph) + "' > /dev/null -o '";
  ASSERT_EQ(call(run + folder.file("alone") + "' --no-cache"), 0);
  const auto alone = files_of(folder, "alone");
  EXPECT_GT(alone.size(), 6u);
  for (const char* round : {"a", "b"}) {
    std::vector<std::thread> processes;
    std::vector<int> codes(3, -1);
    for (std::size_t i = 0; i < codes.size(); ++i)
      processes.emplace_back(
          [&, i] { codes[i] = call(run + folder.file(round + std::to_string(i)) + "' --cache '" + cache + "'"); });
    for (auto& process : processes) process.join();
    for (std::size_t i = 0; i < codes.size(); ++i) {
      EXPECT_EQ(codes[i], 0);
      EXPECT_EQ(files_of(folder, round + std::to_string(i)), alone);
    }
  }
  const Cache kept(cache);
  EXPECT_GT(kept.entries().size(), 8u);
  for (const auto& entry : kept.entries()) EXPECT_EQ(kept.verify(entry.key), "");
}

}  // namespace
}  // namespace talkgraph
