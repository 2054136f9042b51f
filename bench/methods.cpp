// What each method of the comparison costs on GRID s1: learning from the training clips, speaking the validation clips,
// and the size of what was learnt.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/child.h"

namespace talkgraph::bench {

constexpr double clip_seconds = 3;  // of every GRID clip

/// A row of the comparison: the graphs, used as nodes, that learn and that speak; one graph may do both.
struct Method {
  const char* name;
  const char *learns, *speaks;
};

constexpr Method methods[] = {
    {"nearest neighbours", "neighbours", "neighbours"},
    {"nearest neighbours, sound and phones", "neighbours_phones", "neighbours_phones"},
    {"ridge regression", "ridge_sound", "ridge_sound"},
    {"ridge regression, sound and phones", "ridge_phones", "ridge_phones"},
    {"Gaussian process regression", "gp_regression", "gp_regression"},
    {"mean trajectories of contexts", "mean_trajectories", "mean_trajectories"},
    {"shared linear dynamical system", "shared_lds", "shared_lds"},
    {"switching linear dynamical system", "slds", "slds"},
    {"switching linear dynamical system, sound", "slds_sound", "slds_sound"},
    {"deterministic process dynamical system", "dpds", "dpds"},
    {"voice puppetry", "voice_puppetry", "voice_puppetry"},
    {"coupled hidden Markov model", "coupled_hmm", "coupled_hmm"},
    {"trajectory hidden Markov model", "trajectory_hmm", "trajectory_hmm"},
    {"trajectories through phones", "phone_gaussians", "phone_gaussians"},
    {"joint mixture", "joint_gmm", "joint_gmm"},
    {"windowed canonical correlations", "windowed_cca", "windowed_cca"},
    {"one SGPDM", "learnt_one", "one_sgpdm"},
    {"SSGPDM, phones as states", "learnt_phones", "phone_states"},
    {"SSGPDM", "learnt", "said"},
    {"soft contexts", "soft", "soft_said"},
    {"soft contexts, learnt kernel", "soft_learnt", "soft_learnt_said"},
};

using nlohmann::json;

/// Processor time and what is kept of the nodes in a graph used as a node, of those that run once per clip spoken or
/// of the others.
struct Cost {
  double seconds = 0, bytes = 0;
};

Cost cost(const json& nodes, const std::string& part, int clips, bool of_each_clip) {
  Cost sum;
  for (const auto& node : nodes) {
    if (!node["name"].get<std::string>().starts_with("face/" + part + "/")) continue;
    if ((node["calls"] == clips) != of_each_clip) continue;
    sum.seconds += node["cpu_seconds"].get<double>();
    sum.bytes += node["kept_bytes"].get<double>();
  }
  return sum;
}

int calls(const json& nodes, const std::string& name) {
  for (const auto& node : nodes)
    if (node["name"] == name) return node["calls"];
  throw std::runtime_error("no node " + name);
}

void measure(const std::string& talkgraph, const std::string& recordings, const std::filesystem::path& folder) {
  const std::string graph = TALKGRAPH_SOURCE_DIR "/pipelines/tune-grid-s1.json";
  const auto usage = child_usage({talkgraph, "run", graph, "--quiet", "--cache", folder / "cache", "-o", folder / "run",
                                  "--set", "folder=" + recordings});
  const auto nodes = json::parse(std::ifstream(folder / "run" / "run.json"))["nodes"];
  const int clips = calls(nodes, "face/held_parts");
  fmt::print("The whole run: {:.0f} s of processor time in {:.0f} s, {:.2f} GB.\n\n", usage.cpu, usage.wall,
             1e-9 * usage.memory);
  fmt::print(
      "| method | learning, s | as ridge regression | speaking, times real time | MB |\n|---|---|---|---|---|\n");
  const double yardstick = cost(nodes, "ridge_sound", clips, false).seconds;
  for (const auto& m : methods) {
    const auto learning = cost(nodes, m.learns, clips, false), speaking = cost(nodes, m.speaks, clips, true);
    fmt::print("| {} | {:.2f} | {:.1f} | {:.0f} | {} |\n", m.name, learning.seconds, learning.seconds / yardstick,
               clip_seconds * clips / speaking.seconds,
               learning.bytes > 0 ? fmt::format("{:.2f}", 1e-6 * learning.bytes) : "not kept");
  }
}

}  // namespace talkgraph::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: bench_methods TALKGRAPH FOLDER, the program and the recordings of GRID s1\n");
    return 2;
  }
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("talkgraph-bench-{}", getpid());
  int result = 0;
  try {
    talkgraph::bench::measure(argv[1], argv[2], folder);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_methods: {}\n", e.what());
    result = 1;
  }
  std::filesystem::remove_all(folder);
  return result;
}
