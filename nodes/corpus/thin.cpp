#include "nodes/corpus/thin.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>

#include "graph/json.h"

namespace talkgraph {
namespace {

struct Count {
  std::size_t all = 0, seen = 0;
};

/// Of `all`, evenly spread, `most`: whether number `i` is one of them.
bool is_kept(std::size_t i, std::size_t all, std::size_t most) {
  return all <= most || (i + 1) * most / all > i * most / all;
}

}  // namespace

Stream<Recording> Thin::operator()(const Collected<Recording>& recordings) const {
  std::map<std::string, Count> counts;
  for (std::size_t i = 0; i < recordings.size(); ++i) ++counts[recordings[i].split].all;
  std::vector<std::string> names;
  for (const auto& [name, count] : counts) names.push_back(name);
  for (const auto& split : splits)
    if (!counts.contains(split))
      throw std::runtime_error(fmt::format("no recording belongs to the split \"{}\"{}; there are: {}", split,
                                           did_you_mean(split, names), fmt::join(names, ", ")));

  auto kept = std::make_shared<std::vector<Item<Recording>>>();
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    Count& count = counts[recordings[i].split];
    const bool thins = splits.empty() || std::ranges::find(splits, recordings[i].split) != splits.end();
    if (!thins || is_kept(count.seen, count.all, static_cast<std::size_t>(most)))
      kept->push_back({recordings.key(i), recordings[i]});
    ++count.seen;
  }
  return Stream<Recording>(
      [kept, i = std::size_t{0}]() mutable -> std::optional<Item<Recording>> {
        if (i == kept->size()) return {};
        return (*kept)[i++];
      },
      kept->size());
}

void describe(Description<Thin>& d) {
  d.type("corpus.thin").summary("keeps at most so many recordings of a split, spread evenly over it");
  d.input("recordings", "of any split").output("recording", "those kept, in their order");
  d.param("splits", &Thin::splits).doc("names of the splits that lose recordings; empty: each");
  d.param("most", &Thin::most).at_least(1).doc("recordings kept of each of them");
}

}  // namespace talkgraph
