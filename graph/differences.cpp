#include "graph/differences.h"

#include <fmt/format.h>

#include <set>

namespace talkgraph {

std::vector<std::string> differences(const Json& before, const Json& after) {
  if (before == after) return {};
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
