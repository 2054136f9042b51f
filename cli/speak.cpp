#include "cli/speak.h"

#include <fmt/format.h>

#include <cstdio>
#include <stdexcept>

#include "cli/run.h"
#include "nodes/model/save.h"
#include "nodes/types/report.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

void check(const SpeakCommand& command) {
  const auto refuse = [](const std::string& why) { throw std::invalid_argument(why); };
  if (command.files.empty() == command.text.empty()) refuse("give either recordings or --text");
  if (!command.text.empty() && !command.transcripts.empty())
    refuse("--transcript goes with recordings, not with --text");
  if (!command.transcripts.empty() && command.transcripts.size() != command.files.size())
    refuse(fmt::format("{} recordings but {} transcripts: give --transcript once for each recording, in order",
                       command.files.size(), command.transcripts.size()));
  if (command.output.empty() && command.visemes.empty())
    refuse("say where to write: -o clip.mp4, --visemes FILE, or both");
  for (const auto& [path, endings] :
       {std::pair(command.output, std::pair(".mp4", ".webm")), std::pair(command.visemes, std::pair(".tsv", ".json"))})
    if (!path.empty() && command.files.size() < 2 && path.extension() != endings.first &&
        path.extension() != endings.second)
      refuse(fmt::format("{}: the name must end in {} or {}", path.string(), endings.first, endings.second));
}

/// What the model's own graph is told: where the speech is, what to draw upon.
std::vector<std::string> settings(const SpeakCommand& command) {
  const auto set = [](const std::string& path, const Json& value) { return path + "=" + value.dump(); };
  const auto absolute = [](const std::string& file) { return fs::absolute(file).string(); };
  std::vector<std::string> sets = {set("nodes.model.params.file", absolute(command.model))};
  if (command.text.empty()) {
    Json files = Json::array();
    for (const auto& file : command.files) files.push_back(absolute(file));
    sets.push_back(set("nodes.recordings.params.files", files));
    sets.push_back(set("nodes.recordings.params.transcripts", command.transcripts));
  } else {
    sets.push_back(set("nodes.recordings", {{"type", "voice.recordings"}, {"params", {{"texts", {command.text}}}}}));
  }
  if (!command.base.empty()) {
    sets.push_back(set("nodes.base_video", {{"type", "media.video"}, {"params", {{"file", absolute(command.base)}}}}));
    sets.push_back(
        set("nodes.base_track", {{"type", "face.track"}, {"in", {{"model", "model.face"}, {"video", "base_video"}}}}));
    sets.push_back(
        set("nodes.base", {{"type", "face.base_clip"}, {"in", {{"video", "base_video"}, {"track", "base_track"}}}}));
    sets.push_back(set("nodes.composite.in.base", "base"));
  }
  if (command.output.extension() == ".webm") sets.push_back(set("nodes.encode.params.format", "webm"));
  if (command.visemes.extension() == ".json") sets.push_back(set("nodes.visemes.params.format", "json"));
  sets.insert(sets.end(), command.sets.begin(), command.sets.end());
  return sets;
}

/// A folder beside the output, gone when the command ends.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& target) {
    const auto parent = fs::absolute(target).parent_path();
    std::string name = (parent / ".talkgraph-XXXXXX").string();
    if (!fs::is_directory(parent) || !mkdtemp(name.data()))
      throw std::runtime_error(parent.string() + ": is not a folder that can be written to");
    path = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

/// Puts what the graph wrote where the user wants it, and names it on stdout.
void deliver(const RunResult& result, const std::string& output, const fs::path& from, const fs::path& to,
             bool several) {
  const auto& items = result.output(output).items;
  if (items.empty()) throw std::runtime_error(fmt::format("the model's graph gave no {}", output));
  if (several) fs::create_directories(to);
  for (const auto& item : items) {
    const fs::path written = from / item.value.get<Artifact>().path;
    const fs::path target = several ? to / written.filename() : to;
    fs::rename(written, target);
    fmt::print("{}\n", target.string());
  }
}

}  // namespace

int speak(const SpeakCommand& command, const Registry& registry) {
  check(command);
  Diagnostics diagnostics;
  const auto graph =
      load_graph_text(command.model, model_graph(command.model), registry, diagnostics, {settings(command)});
  if (!graph) {
    fmt::print(stderr, "{}", diagnostics.str());
    return usage;
  }
  const WorkFolder work(command.output.empty() ? command.visemes : command.output);
  RunCommand run;
  run.folder = work.path;
  run.threads = command.threads;
  run.quiet = command.quiet;
  const Outcome outcome = run_graph(*graph, run);
  if (!outcome.result) return outcome.code;
  const bool several = command.files.size() > 1;
  if (!command.output.empty()) deliver(*outcome.result, "clips", work.path, command.output, several);
  if (!command.visemes.empty()) deliver(*outcome.result, "visemes", work.path, command.visemes, several);
  return success;
}

}  // namespace talkgraph::cli
