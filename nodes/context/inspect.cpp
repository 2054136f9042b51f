#include "nodes/context/inspect.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "nodes/context/automaton.h"

namespace talkgraph {
namespace {

void add_row(Table& table, const std::string& name, std::vector<double> cells) {
  table.rows.push_back(name);
  table.cells.push_back(std::move(cells));
}

double entropy(const std::vector<double>& probability) {
  double bits = 0;
  for (const double p : probability)
    if (p > 0) bits -= p * std::log2(p);
  return bits;
}

void list_states(const Vlmm& vlmm, Table& memories, Table& transitions) {
  for (std::size_t from = 0; from < vlmm.states.size(); ++from) {
    const auto& state = vlmm.states[from];
    const std::string memory = memory_label(vlmm, state.memory);
    double followers = 0;
    for (std::size_t s = 0; s < vlmm.alphabet.size(); ++s) {
      if (state.next[s] < 0) continue;
      ++followers;
      const std::string label = (memory.empty() ? "" : memory + "-") + vlmm.alphabet[s];
      const auto frames = vlmm.occupancy.find(label);
      add_row(transitions, label,
              {static_cast<double>(from), static_cast<double>(state.next[s]), state.probability[s],
               frames == vlmm.occupancy.end() ? 0 : static_cast<double>(frames->second)});
    }
    add_row(memories, memory.empty() ? "none" : memory,
            {static_cast<double>(from), static_cast<double>(state.memory.size()),
             static_cast<double>(frames_read(vlmm, from)), followers, entropy(state.probability)});
  }
}

/// All labels, the most occupied first.
void list_labels(const Vlmm& vlmm, double all, Table& labels) {
  auto names = vlmm.occupancy;
  for (const auto& window : vlmm.windows) names.try_emplace(window.first, 0);
  std::vector<std::pair<std::string, std::int64_t>> sorted(names.begin(), names.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  for (const auto& [label, frames] : sorted) {
    const auto windows = vlmm.windows.find(label);
    add_row(labels, label,
            {static_cast<double>(label_phones(label).size()), static_cast<double>(frames),
             static_cast<double>(frames) / all,
             windows == vlmm.windows.end() ? NAN : static_cast<double>(windows->second)});
  }
}

}  // namespace

InspectContexts::Out InspectContexts::operator()(const Vlmm& vlmm) const {
  Out out{{"Phonetic contexts", "contexts", {}, {"all"}, {}},
          {"Memories", "memory", {"number", "length", "frames", "followers", "entropy"}, {}, {}},
          {"Labels by the frames that carry them", "label", {"length", "frames", "share", "windows"}, {}, {}},
          {"Transitions", "label", {"from", "to", "probability", "frames"}, {}, {}}};
  std::vector<double> occupied;
  for (const auto& label : vlmm.occupancy) occupied.push_back(static_cast<double>(label.second));
  std::sort(occupied.begin(), occupied.end());
  const double all = std::accumulate(occupied.begin(), occupied.end(), 0.0);
  const auto rare = std::upper_bound(occupied.begin(), occupied.end(), static_cast<double>(thin));
  list_states(vlmm, out.memories, out.transitions);
  list_labels(vlmm, all, out.labels);

  const auto n = occupied.size();
  out.summary.columns = {"memories", "transitions", "labels", "trainable", "thin", "thin share", "median"};
  out.summary.cells = {{static_cast<double>(vlmm.states.size()), static_cast<double>(out.transitions.rows.size()),
                        static_cast<double>(n), static_cast<double>(state_labels(vlmm).size()),
                        static_cast<double>(rare - occupied.begin()),
                        std::accumulate(occupied.begin(), rare, 0.0) / all,
                        n == 0 ? NAN : (occupied[n / 2] + occupied[(n - 1) / 2]) / 2}};
  return out;
}

void describe(Description<InspectContexts>& d) {
  d.type("context.inspect").summary("memories, labels and transitions of contexts as tables");
  d.source("Thesis §5.2.4, Figures 5.7 and 5.8");
  d.input("vlmm", "the contexts")
      .output("summary", &InspectContexts::Out::summary,
              "one row; memories: how many; transitions: how many; labels: how many; trainable: labels that have a "
              "state of "
              "their own; thin: labels that at most `thin` frames carry; thin share: of all frames, those of thin "
              "labels; median: "
              "frames of a label")
      .output("memories", &InspectContexts::Out::memories, "length, training frames, what may follow")
      .output("labels", &InspectContexts::Out::labels, "training frames and windows, the most occupied first")
      .output("transitions", &InspectContexts::Out::transitions, "from and to which memory, how likely");
  d.param("thin", &InspectContexts::thin).at_least(0).unit("frames").doc("labels of at most so many count as thin");
}

}  // namespace talkgraph
