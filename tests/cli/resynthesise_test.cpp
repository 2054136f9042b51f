#include <gtest/gtest.h>

#include <cmath>

#include "nodes/all_nodes.h"
#include "nodes/media/audio_file.h"
#include "runtime/executor.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph::cli {
namespace {

double decibels(const Eigen::VectorXd& x) { return 10 * std::log10(x.squaredNorm() / static_cast<double>(x.size())); }

TEST(Resynthesise, ThePipelineWritesEverySentenceAgainAsLoud) {
#ifndef TALKGRAPH_ESPEAK
  GTEST_SKIP() << "built without espeak-ng, which speaks the sentences";
#endif
  const test::TemporaryFolder folder;
  const Registry registry = all_nodes();
  Diagnostics diagnostics;
  const auto graph = load_graph(test::source("/pipelines/resynthesise.json"), registry, diagnostics);
  ASSERT_TRUE(graph) << diagnostics.str();
  RunOptions options;
  options.folder = folder.path();
  run(*graph, options);
  int sentences = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "sound")) {
    const std::string file = entry.path().string(), ending = "-original.wav";
    if (!file.ends_with(ending)) continue;
    const Audio original = read_audio(file), made = read_audio(file.substr(0, file.size() - ending.size()) + ".wav");
    EXPECT_NEAR(made.seconds(), original.seconds(), 0.011);  // whole frames
    EXPECT_NEAR(decibels(made.samples), decibels(original.samples), 2);
    ++sentences;
  }
  EXPECT_EQ(sentences, 2);
}

}  // namespace
}  // namespace talkgraph::cli
