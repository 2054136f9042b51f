#include "cli/speak.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "cli/run.h"
#include "graph/output_file.h"
#include "nodes/corpus/text.h"
#include "nodes/model/save.h"
#include "nodes/types/report.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

std::string ending(const fs::path& path) {
  std::string text = path.extension().string();
  for (auto& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// One file for one recording, a folder for several; told before anything is computed.
void check_target(const fs::path& path, const std::set<std::string>& endings, bool several) {
  if (path.empty()) return;
  const bool names_a_file = endings.contains(ending(path));
  if (!several && !names_a_file)
    throw std::invalid_argument(fmt::format("{}: the name must end in {}", path.string(), fmt::join(endings, " or ")));
  if (several && names_a_file)
    throw std::invalid_argument(
        fmt::format("{}: several recordings go to a folder, whose name does not end so", path.string()));
  if (!several && fs::is_directory(path)) throw std::invalid_argument(path.string() + ": is a folder; name a file");
  if (several && fs::exists(path) && !fs::is_directory(path))
    throw std::invalid_argument(path.string() + ": is a file; several recordings go to a folder");
}

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
  const bool several = command.files.size() > 1;
  check_target(command.output, {".mp4", ".webm"}, several);
  check_target(command.visemes, {".tsv", ".json"}, several);
}

/// A transcript that ends in .txt names a file, as in a manifest.
std::vector<std::string> transcripts(const SpeakCommand& command) {
  std::vector<std::string> out;
  for (const auto& text : command.transcripts) out.push_back(text.ends_with(".txt") ? read_text_file(text) : text);
  return out;
}

/// What the model's own graph is told: where the speech is, what to draw upon.
std::vector<std::string> settings(const SpeakCommand& command) {
  const auto set = [](const std::string& path, const Json& value) {
    try {
      return path + "=" + value.dump();
    } catch (const Json::type_error&) {
      throw std::invalid_argument("a text or the name of a file is not UTF-8");
    }
  };
  const auto absolute = [](const std::string& file) { return fs::absolute(file).string(); };
  std::vector<std::string> sets = {set("nodes.model.params.file", absolute(command.model))};
  if (command.text.empty()) {
    Json files = Json::array();
    for (const auto& file : command.files) files.push_back(absolute(file));
    sets.push_back(set("nodes.recordings.params.files", files));
    sets.push_back(set("nodes.recordings.params.transcripts", transcripts(command)));
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
  const auto leave_out = [&](const std::string& node, const std::string& output) {
    sets.push_back(set("nodes." + node, nullptr));
    sets.push_back(set("outputs." + output, nullptr));
  };
  if (command.output.empty()) leave_out("encode", "clips");
  if (command.visemes.empty()) leave_out("visemes", "visemes");
  if (ending(command.output) == ".webm") sets.push_back(set("nodes.encode.params.format", "webm"));
  if (ending(command.visemes) == ".json") sets.push_back(set("nodes.visemes.params.format", "json"));
  sets.insert(sets.end(), command.sets.begin(), command.sets.end());
  return sets;
}

/// The folder that a target lies in, or is where there are several recordings; made if need be.
fs::path folder_of(const fs::path& target, bool several) {
  const fs::path folder = several ? fs::absolute(target) : fs::absolute(target).parent_path();
  std::error_code error;
  if (several) fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": there is no such folder");
  if (access(folder.c_str(), W_OK) != 0) throw std::runtime_error(folder.string() + ": one may not write there");
  return folder;
}

/// A folder for what the graph writes, gone when the command ends.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& parent) {
    std::string name = (parent / ".talkgraph-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error(parent.string() + ": no folder can be made there");
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
  if (to.empty()) return;
  for (const auto& item : result.output(output).items) {
    if (!item.value) continue;
    const fs::path written = from / item.value.get<Artifact>().path;
    const fs::path target = several ? to / written.filename() : to;
    OutputFile file(target);
    fs::copy_file(written, file.part());
    file.finish();
    fmt::print("{}\n", target.string());
  }
}

}  // namespace

int speak(const SpeakCommand& command, const Registry& registry) {
  check(command);
  Diagnostics diagnostics;
  auto graph = load_graph_text(command.model, model_graph(command.model), registry, diagnostics, {settings(command)});
  if (!graph) {
    fmt::print(stderr, "{}\n", diagnostics.str());
    return usage;
  }
  for (auto& node : graph->nodes) node.place = {};  // places in a model file tell a user nothing
  const bool several = command.files.size() > 1;
  for (const auto& target : {command.output, command.visemes})
    if (!target.empty()) folder_of(target, several);
  const WorkFolder work(folder_of(command.output.empty() ? command.visemes : command.output, several));
  RunCommand run;
  run.folder = work.path;
  run.threads = command.threads;
  run.progress = command.progress;
  run.keep_going = true;
  const Outcome outcome = run_graph(*graph, run);
  if (!outcome.result) return outcome.code;
  deliver(*outcome.result, "clips", work.path, command.output, several);
  deliver(*outcome.result, "visemes", work.path, command.visemes, several);
  return outcome.code;
}

}  // namespace talkgraph::cli
