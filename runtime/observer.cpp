#include "runtime/observer.h"

namespace talkgraph {
namespace {

const char* status_text(const RunReport& report) {
  switch (report.status) {
    case RunReport::Status::finished:
      return report.failures.empty() ? "finished" : "finished with failures";
    case RunReport::Status::failed:
      return "failed";
    case RunReport::Status::cancelled:
      return "cancelled";
  }
  return "";
}

}  // namespace

Json to_json(const Failure& f) { return {{"node", f.node}, {"item", f.item}, {"place", f.place}, {"cause", f.cause}}; }

Json to_json(const Graph& graph, const RunReport& report) {
  Json json = {{"status", status_text(report)}, {"seconds", report.wall}};
  if (!report.error.empty()) json["error"] = report.error;
  json["failures"] = Json::array();
  for (const auto& f : report.failures) json["failures"].push_back(to_json(f));
  json["nodes"] = Json::array();
  for (std::size_t n = 0; n < report.nodes.size(); ++n) {
    const auto& stats = report.nodes[n];
    json["nodes"].push_back({{"name", graph.nodes[n].name},
                             {"type", graph.nodes[n].type->name},
                             {"calls", stats.calls},
                             {"skipped", stats.skipped},
                             {"failed", stats.failed},
                             {"loaded", stats.loaded},
                             {"unneeded", stats.unneeded},
                             {"saved_seconds", stats.saved},
                             {"kept_bytes", stats.kept},
                             {"seconds", stats.wall},
                             {"cpu_seconds", stats.cpu}});
  }
  return json;
}

}  // namespace talkgraph
