#include "runtime/run_folder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "graph/output_file.h"
#include "runtime/memory.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

std::string utc(std::chrono::system_clock::time_point t, const char* format) {
  return fmt::format(fmt::runtime(fmt::format("{{:{}}}", format)),
                     fmt::gmtime(std::chrono::system_clock::to_time_t(t)));
}
std::string iso(std::chrono::system_clock::time_point t) { return utc(t, "%Y-%m-%dT%H:%M:%SZ"); }

fs::path unused_folder(const Graph& graph, std::chrono::system_clock::time_point now) {
  std::string name = fs::path(graph.name).stem().string();
  if (name.empty()) name = "graph";
  const fs::path wanted = fs::path("runs") / (name + "-" + utc(now, "%Y%m%dT%H%M%SZ"));
  fs::path path = wanted;
  for (int i = 2; fs::exists(path); ++i) path = wanted.string() + "-" + std::to_string(i);
  return path;
}

/// The files that a run writes, a JSON text a line, until its run.json lists them: a run that is killed leaves it.
constexpr auto journal = ".written";

/// What an earlier run wrote, as its run.json lists it, or its journal if it was killed.
std::vector<std::string> written_earlier(const fs::path& folder) {
  std::vector<std::string> files;
  const auto take = [&](const Json& name) {
    if (name.is_string()) files.push_back(name);
  };
  std::ifstream report(folder / "run.json"), lines(folder / journal);
  const Json run = Json::parse(report, nullptr, false);
  if (run.is_object())
    for (const auto& name : run.value("files", Json::array())) take(name);
  for (std::string line; std::getline(lines, line);) take(Json::parse(line, nullptr, false));
  return files;
}

/// Removes what an earlier run wrote, and the folders that are empty then.
void clear_earlier_run(const fs::path& folder) {
  for (const auto& name : written_earlier(folder)) {
    const fs::path file = fs::path(name).lexically_normal();
    if (file.empty() || file.is_absolute() || *file.begin() == "..") continue;
    std::error_code left;
    fs::remove(folder / file, left);
    for (auto parent = file.parent_path(); !parent.empty() && !left; parent = parent.parent_path())
      fs::remove(folder / parent, left);
  }
  fs::remove(folder / journal);
}

}  // namespace

RunFolder::RunFolder(const Graph& graph, fs::path path)
    : graph_(graph), path_(path.empty() ? unused_folder(graph, started_) : std::move(path)) {
  try {
    fs::create_directories(path_);
    sweep_parts(path_);
    clear_earlier_run(path_);
    write_file(path_ / "graph.resolved.json", graph.resolved.dump(2) + "\n");
    write_file(path_ / "run.json", header("running").dump(2) + "\n");
    log_.open(path_ / "log.txt", std::ios::app);
    written_.open(path_ / journal);
    if (!log_ || !written_) throw std::runtime_error(fmt::format("{} cannot be written", path_.string()));
  } catch (const std::exception& e) {
    throw std::runtime_error(
        fmt::format("the run folder {} cannot be used: {}; choose another one", path_.string(), e.what()));
  }
}

void RunFolder::log(std::string_view message) {
  const std::lock_guard lock(mutex_);
  log_ << iso(Clock::now()) << ' ' << message << std::endl;
}

void RunFolder::started(const Graph&) { log(fmt::format("started {}", graph_.name)); }

void RunFolder::log(int node, const std::string& item, std::string_view message) {
  const auto& name = graph_.nodes[static_cast<std::size_t>(node)].name;
  log(item.empty() ? fmt::format("{}: {}", name, message) : fmt::format("{} [{}]: {}", name, item, message));
}

void RunFolder::warn(int node, const std::string& item, std::string_view message) {
  log(node, item, fmt::format("warning: {}", message));
}

void RunFolder::notice(std::string_view message) { log(fmt::format("warning: {}", message)); }

void RunFolder::writes(const std::string& file) {
  const std::lock_guard lock(mutex_);
  written_ << Json(file).dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

void RunFolder::failed(const Failure& failure) { log(failure.str()); }

Json RunFolder::header(const std::string& status) const {
  Json json;
  json["status"] = status;
  json["graph"] = graph_.name;
  json["started"] = iso(started_);
  return json;
}

void RunFolder::ended(const RunReport& report) {
  Json json = header("");
  json["ended"] = iso(Clock::now());
  json["peak_memory_bytes"] = peak_memory();
  json.update(to_json(graph_, report));
  json["files"] = report.files;
  write_file(path_ / "run.json", json.dump(2) + "\n");
  written_.close();
  fs::remove(path_ / journal);
  const std::string status = json["status"];
  log(report.error.empty() ? status : status + ": " + report.error);
}

}  // namespace talkgraph
