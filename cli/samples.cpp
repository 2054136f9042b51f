#include "cli/samples.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/example.h"
#include "graph/output_file.h"
#include "nodes/types/phones.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

/// Word times as GRID has them: 1/25000 s.
std::string grid_align(const WordTrack& words) {
  std::string out;
  for (const auto& w : words.words)
    out += fmt::format("{} {} {}\n", std::lround(w.start * 25000), std::lround(w.end * 25000), w.label);
  return out;
}

void write_corpora(const RunResult& result, const fs::path& folder) {
  Json clips = Json::array(), names = Json::array();
  for (const auto& [id, words] : result.output("words").items) {
    const auto clip = folder / "clips" / (id + ".mp4"), twin = folder / "grid" / "video" / (id + ".mpg");
    clips.push_back({{"id", id}, {"video", "clips/" + id + ".mp4"}, {"audio", "sound/" + id + ".wav"}});
    names.push_back(id);
    OutputFile copy(twin);
    fs::copy_file(clip, copy.part());
    copy.finish();
    write_file(folder / "grid" / "align" / (id + ".align"), grid_align(words.get<WordTrack>()));
  }
  for (const auto& [id, transcript] : result.output("transcript").items)
    for (auto& clip : clips)
      if (clip["id"] == id) clip["transcript"] = transcript.get<Transcript>().text;
  write_file(folder / "grid" / "split.json", Json{{"train", names}}.dump(1) + "\n");
  write_file(folder / "manifest.json", Json{{"clips", clips}}.dump(1) + "\n");
}

}  // namespace

int write_samples(RunCommand command, const Registry& registry) {
  if (command.folder.empty()) command.folder = "samples";
  const Json graph = {
      {"nodes", example_nodes({"write_audio", "encode", "save"})},
      {"outputs", {{"words", "parts.words"}, {"transcript", "parts.transcript"}}},
  };
  Diagnostics diagnostics;
  const auto loaded = load_graph_text("examples.json", graph.dump(), registry, diagnostics);
  if (!loaded) throw std::logic_error(diagnostics.str());
  const Outcome outcome = run_graph(*loaded, command);
  if (!outcome.result) return outcome.code;
  write_corpora(*outcome.result, command.folder);
  fmt::print("{}\n", command.folder.string());
  return success;
}

}  // namespace talkgraph::cli
