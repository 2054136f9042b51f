#include "graph/differences.h"

#include <fmt/format.h>

#include <set>

namespace talkgraph {
namespace {

Json inner_graph(const Json& value) {
  if (!value.is_string() || !value.get<std::string>().starts_with('{')) return {};
  return Json::parse(value.get<std::string>(), nullptr, false);
}

}  // namespace

std::vector<std::string> differences(const Json& before, const Json& after) {
  if (before == after) return {};
  // A graph given as a parameter.
  if (const Json a = inner_graph(before), b = inner_graph(after); a.is_object() && b.is_object())
    return differences(a, b);
  if (!before.is_object() || !after.is_object()) {
    const auto text = [](const Json& j) { return j.is_null() ? "nothing" : j.dump(); };
    return {fmt::format(": {} -> {}", text(before), text(after))};
  }
  std::set<std::string> names;
  for (const auto* json : {&before, &after})
    for (const auto& [name, value] : json->items()) names.insert(name);
  std::vector<std::string> all;
  for (const auto& name : names)
    for (const auto& inner : differences(before.value(name, Json()), after.value(name, Json())))
      all.push_back(inner.starts_with(':') ? name + inner : name + "/" + inner);
  return all;
}

}  // namespace talkgraph
