// What the switching model costs on GRID s1: training its states, optimisation and prediction of the validation clips.
// Processor time, and the wall clock where two threads train.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/child.h"

namespace talkgraph::bench {

constexpr double clip_seconds = 3;  // of every GRID clip

/// Runs of the main path as far as its scores, in folders of their own; what a run has kept the next one finds.
class Runs {
 public:
  Runs(std::string talkgraph, std::string recordings)
      : talkgraph_(std::move(talkgraph)), recordings_(std::move(recordings)) {}
  Runs(const Runs&) = delete;
  ~Runs() { std::filesystem::remove_all(folder_); }

  struct Outcome {
    Usage usage;
    nlohmann::json nodes;

    const nlohmann::json& of(const std::string& name) const {
      for (const auto& node : nodes)
        if (node["name"] == name) return node;
      throw std::runtime_error("no node " + name);
    }
  };
  Outcome run(int threads, const std::vector<std::string>& sets) {
    const std::string out = folder_ / std::to_string(count_++);
    std::vector<std::string> command = {talkgraph_,
                                        "run",
                                        TALKGRAPH_SOURCE_DIR "/pipelines/online-grid-s1.json",
                                        "--quiet",
                                        "--threads",
                                        std::to_string(threads),
                                        "--cache",
                                        folder_ / "cache",
                                        "-o",
                                        out};
    const auto set = [&](const std::string& change) { command.insert(command.end(), {"--set", change}); };
    set("folder=" + recordings_);
    for (const auto& change : sets) set(change);
    const Usage usage = child_usage(command);
    return {usage, nlohmann::json::parse(std::ifstream(out + "/run.json"))["nodes"]};
  }

 private:
  std::string talkgraph_, recordings_;
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / fmt::format("talkgraph-bench-{}", getpid());
  int count_ = 0;
};

void measure(Runs& runs) {
  const auto all = runs.run(2, {"nodes.face/learnt/sgpdm.params.iterations=0"});
  const auto trained = runs.run(2, {});
  const auto& states = trained.of("face/learnt/sgpdm");
  fmt::print("| GRID s1, training clips | |\n|---|---|\n");
  fmt::print("| states | {} |\n", states["calls"].get<int>());
  fmt::print("| training them, processor time | {:.0f} s |\n", states["cpu_seconds"].get<double>());
  fmt::print("| the run with two threads, features and tracks at hand | {:.0f} s; {:.0f} s of processor time |\n",
             trained.usage.wall, trained.usage.cpu);
  fmt::print("| its memory | {:.2f} GB |\n", 1e-9 * trained.usage.memory);
  fmt::print("| memory of the run before, from recordings on | {:.2f} GB |\n\n", 1e-9 * all.usage.memory);

  fmt::print("| synthesis, one thread | ms a clip | times real time |\n|---|---|---|\n");
  const auto row = [](const char* name, const nlohmann::json& node) {
    const double seconds = node["cpu_seconds"].get<double>() / node["calls"].get<double>();
    fmt::print("| {} | {:.1f} | {:.0f} |\n", name, 1e3 * seconds, clip_seconds / seconds);
  };
  const std::string anew = "nodes.face/said/synthesise.params.hmm_states=499";  // changes nothing but the result's key
  row("optimisation", runs.run(1, {anew}).of("face/said/synthesise"));
  row("prediction", runs.run(1, {anew, "nodes.face/said/synthesise.params.method=predict"}).of("face/said/synthesise"));
  row("optimisation as speech comes", trained.of("face/online/synthesise"));
}

}  // namespace talkgraph::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: bench_switching TALKGRAPH FOLDER, the program and the recordings of GRID s1\n");
    return 2;
  }
  try {
    talkgraph::bench::Runs runs(argv[1], argv[2]);
    talkgraph::bench::measure(runs);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_switching: {}\n", e.what());
    return 1;
  }
}
