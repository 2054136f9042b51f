#include "study/finished_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>

#include "nodes/types/appearance_model.h"
#include "nodes/types/audio.h"
#include "nodes/types/mouths.h"
#include "nodes/types/paired.h"
#include "nodes/types/recording.h"
#include "nodes/types/report.h"

namespace talkgraph::study {
namespace {

namespace fs = std::filesystem;

constexpr auto graph_file = "graph.resolved.json";

Json read_json(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw std::runtime_error(fmt::format("{}: is not the folder of a run: {} cannot be read; `talkgraph run` makes one",
                                         file.parent_path().string(), file.filename().string()));
  Json json = Json::parse(in, nullptr, false);
  if (!json.is_object()) throw std::runtime_error(fmt::format("{}: is damaged: run again", file.string()));
  return json;
}

void check_finished(const fs::path& folder, const Json& run) {
  const auto status = run.value("status", "");
  if (status == "finished") return;
  const auto failures = run.value("failures", Json::array());
  std::string why = run.value("error", "");
  if (!failures.empty())
    why = fmt::format("{} failed, the first of them {} [{}]: {}", failures.size(), failures[0].value("node", ""),
                      failures[0].value("item", ""), failures[0].value("cause", ""));
  if (status == "running") why = "it still runs, or was killed";
  throw std::runtime_error(
      fmt::format("{}: the run has not finished as it should{}: take what fails out of it, and run "
                  "it to its end; what is done is found again",
                  folder.string(), why.empty() ? "" : " (" + why + ")"));
}

std::string title_of(const Json& graph, const fs::path& folder) {
  for (const auto& node : graph.at("nodes"))
    if (node.value("type", "") == "report.write") {
      auto title = node.value("params", Json::object()).value("title", "");
      if (!title.empty() && title != "talkgraph report") return title;
    }
  return fs::weakly_canonical(folder).filename().string();
}

std::string node_of(const std::string& port) { return port.substr(0, port.rfind('.')); }

/// A port as the design names it: an output, or what is wired to an input. Empty if there is none.
std::string output_of(const std::string& name, const Json& nodes, const Registry& registry) {
  const auto dot = name.rfind('.');
  const std::string node = name.substr(0, dot), port = dot == std::string::npos ? "" : name.substr(dot + 1);
  const auto* type = nodes.contains(node) ? registry.find(nodes.at(node).value("type", "")) : nullptr;
  if (!type) return {};
  for (const auto& output : type->outputs)
    if (output.name == port || (port.empty() && type->outputs.size() == 1))
      return fmt::format("{}.{}", node, output.name);
  const Json in = nodes.at(node).value("in", Json::object());
  return in.contains(port) && in.at(port).is_string() ? in.at(port).get<std::string>() : "";
}

std::string type_of(const std::string& output, const Json& nodes, const Registry& registry) {
  const auto* type = registry.find(nodes.at(node_of(output)).value("type", ""));
  const auto name = output.substr(output.rfind('.') + 1);
  if (type)
    for (const auto& port : type->outputs)
      if (port.name == name) return std::string(port.type.name);
  return {};
}

const std::map<std::string, std::string>& wanted_types() {
  static const std::map<std::string, std::string> types = {
      {"face", std::string(port_type<AppearanceModel>.name)}, {"recorded", std::string(port_type<Track>.name)},
      {"synthesised", std::string(port_type<Track>.name)},    {"mean", std::string(port_type<Track>.name)},
      {"mouths", std::string(port_type<Mouths>.name)},        {"audio", std::string(port_type<Audio>.name)},
      {"recordings", std::string(port_type<Recording>.name)}, {"sentences", std::string(port_type<Recording>.name)}};
  return types;
}

const Value* find(const RunResult::Output& output, const std::string& key) {
  for (const auto& item : output.items)
    if (item.key == key) return &item.value;
  return nullptr;
}

/// The clips of a test that are drawn alike.
struct Batch {
  std::string name;  ///< of its node and its folder
  const Test* test = nullptr;
  bool synthetic = false;
  std::string eyes;
  std::map<std::string, std::string> clips;  ///< ids by sequence
};

std::vector<Batch> batches(const Study& study, const std::string& speaker) {
  std::map<std::string, Batch> by_name;
  for (const auto& test : study.tests)
    for (const auto& clip : test.clips) {
      if (clip.speaker != speaker) continue;
      const auto name = fmt::format("study:{}-{}{}{}", test.id, clip.synthetic ? "synthetic" : "real",
                                    clip.eyes.empty() ? "" : "-", clip.eyes);
      auto& batch = by_name.try_emplace(name, Batch{name, &test, clip.synthetic, clip.eyes, {}}).first->second;
      batch.clips.emplace(clip.sequence, clip.id);
    }
  std::vector<Batch> out;
  for (auto& [name, batch] : by_name) out.push_back(std::move(batch));
  return out;
}

Json drawing(const Batch& batch, const Design& design, const Ports& ports) {
  Json in = {{"face", ports.face},         {"shown", batch.synthetic ? ports.synthesised : ports.recorded},
             {"recorded", ports.recorded}, {"synthesised", ports.synthesised},
             {"mean", ports.mean},         {"mouths", ports.mouths}};
  if (batch.test->kind != TestKind::intelligibility) in["audio"] = ports.audio;
  Json ids = Json::array();
  for (const auto& [sequence, clip] : batch.clips) ids.push_back(sequence);
  return {{"graph", design.draw.path},
          {"in", in},
          {"params",
           {{"ids", ids},
            {"part", batch.test->kind == TestKind::turing ? "lower" : "whole"},
            {"eyes", batch.test->kind == TestKind::turing ? "base"
                     : batch.eyes == "static"             ? "still"
                                                          : "given"},
            {"folder", batch.name}}}};
}

}  // namespace

FinishedRun::FinishedRun(fs::path folder) : folder_(std::move(folder)) {
  check_finished(folder_, read_json(folder_ / "run.json"));
  graph_ = read_json(folder_ / graph_file);
  if (!graph_.contains("nodes")) throw std::runtime_error(fmt::format("{}: is damaged: run again", folder_.string()));
  title_ = title_of(graph_, folder_);
}

bool FinishedRun::find(const Design& design, const Registry& registry, Diagnostics& diagnostics) {
  const auto& nodes = graph_.at("nodes");
  std::vector<std::string> known;
  for (const auto& [name, node] : nodes.items()) known.push_back(name);
  std::map<std::string, std::string> found;
  bool ok = true;
  const auto complain = [&](const std::string& role, const std::string& text) {
    diagnostics.error(design.at({"take", role}), fmt::format("\"{}\": {} {}: name the port of that graph that is meant",
                                                             role, folder_.string(), text));
    ok = false;
  };
  for (const auto& [role, name] : design.ports.all()) {
    if (name.empty()) continue;
    const auto output = output_of(name, nodes, registry);
    if (output.empty()) {
      complain(role, nodes.contains(node_of(name))
                         ? fmt::format("has a node \"{}\", but no port \"{}\" of it", node_of(name), name)
                         : fmt::format("has no node \"{}\"{}", node_of(name), did_you_mean(node_of(name), known)));
      continue;
    }
    const auto type = type_of(output, nodes, registry);
    if (type != wanted_types().at(role))
      complain(role, fmt::format("gives {} at \"{}\", not {}", type, name, wanted_types().at(role)));
    found[role] = output;
  }
  ports_ = {found["face"],   found["recorded"], found["synthesised"], found["mean"],
            found["mouths"], found["audio"],    found["recordings"],  found["sentences"]};
  return ok;
}

/// The nodes that lead to some ports.
Json FinishedRun::needed(const std::vector<std::string>& ports) const {
  std::set<std::string> names;
  const std::function<void(const Json&)> visit = [&](const Json& wire) {
    if (wire.is_object())
      for (const auto& one : wire) visit(one);
    if (!wire.is_string() || wire.get<std::string>().empty()) return;
    const auto node = node_of(wire.get<std::string>());
    if (!names.insert(node).second) return;
    for (const auto& source : graph_.at("nodes").at(node).value("in", Json::object())) visit(source);
  };
  for (const auto& port : ports) visit(port);
  Json nodes = Json::object();
  for (const auto& [name, node] : graph_.at("nodes").items())
    if (names.contains(name)) nodes[name] = node;
  return nodes;
}

Graph FinishedRun::load(Json nodes, const Json& outputs, const Registry& registry) const {
  const Json json = {{"seed", graph_.value("seed", 1)}, {"nodes", std::move(nodes)}, {"outputs", outputs}};
  Diagnostics diagnostics;
  auto graph = load_graph_text((folder_ / "study.json").string(), json.dump(1), registry, diagnostics);
  if (!graph)
    throw std::runtime_error(fmt::format("{}: the graph of the run does not take what draws the clips:\n{}",
                                         folder_.string(), diagnostics.str()));
  return *std::move(graph);
}

Speaker FinishedRun::speaker(const Registry& registry, const RunGraph& run, const fs::path& desk) const {
  Json outputs = {
      {"recordings", ports_.recordings}, {"recorded", ports_.recorded}, {"synthesised", ports_.synthesised}};
  if (!ports_.sentences.empty()) outputs["sentences"] = ports_.sentences;
  std::vector<std::string> ports;
  for (const auto& port : outputs) ports.push_back(port);
  const auto result = run(load(needed(ports), outputs, registry), desk);
  Speaker speaker{title_, {}, {}};
  for (const auto& item : result.output("recordings").items) {
    const auto* recorded = study::find(result.output("recorded"), item.key);
    const auto* synthesised = study::find(result.output("synthesised"), item.key);
    if (!recorded || !synthesised) continue;
    const auto& transcript = item.value.get<Recording>().transcript;
    const auto& a = recorded->get<Track>();
    const auto& b = synthesised->get<Track>();
    const auto frames = common_frames(item.key, a.frames(), "recorded frames", b.frames(), "synthesised ones");
    if (frames > 0)
      speaker.sequences.push_back(
          {item.key, transcript ? transcript->text : "", static_cast<double>(frames) / a.rate.value()});
  }
  if (speaker.sequences.empty())
    throw std::runtime_error(
        fmt::format("{}: the run has no sequences held out of training and synthesised: there is nothing to show",
                    folder_.string()));
  if (!ports_.sentences.empty())
    for (const auto& item : result.output("sentences").items)
      if (const auto& transcript = item.value.get<Recording>().transcript)
        speaker.sentences.push_back(transcript->text);
  return speaker;
}

void FinishedRun::draw(const Design& design, const Study& study, const std::string& speaker, const Registry& registry,
                       const RunGraph& run, const fs::path& desk) const {
  const auto all = batches(study, speaker);
  Json nodes = needed({ports_.face, ports_.recorded, ports_.synthesised, ports_.mean, ports_.mouths, ports_.audio});
  Json outputs = Json::object();
  for (const auto& batch : all) {
    nodes[batch.name] = drawing(batch, design, ports_);
    for (const char* format : {"webm", "mp4"}) outputs[batch.name + format] = fmt::format("{}.{}", batch.name, format);
  }
  const auto result = run(load(std::move(nodes), outputs, registry), desk);
  fs::create_directories(desk / "clips");
  for (const auto& batch : all)
    for (const char* format : {"webm", "mp4"})
      for (const auto& [sequence, id] : batch.clips) {
        const auto* file = study::find(result.output(batch.name + format), sequence);
        if (!file) throw std::runtime_error(fmt::format("{}: no clip was drawn of {}", folder_.string(), sequence));
        fs::rename(desk / file->get<Artifact>().path, desk / "clips" / fmt::format("{}.{}", id, format));
      }
}

}  // namespace talkgraph::study
