#include "nodes/types/vlmm.h"

#include <algorithm>

namespace talkgraph {

std::vector<std::string> label_phones(const std::string& label) {
  std::vector<std::string> phones;
  for (std::size_t at = 0; at <= label.size();) {
    const auto dash = std::min(label.find('-', at), label.size());
    phones.push_back(label.substr(at, dash - at));
    at = dash + 1;
  }
  return phones;
}

std::string join_phones(const std::vector<std::string>& phones, std::size_t from, std::size_t to) {
  std::string label;
  for (std::size_t i = from; i < to; ++i) label += (label.empty() ? "" : "-") + phones[i];
  return label;
}

void fields(Archive& ar, Vlmm::State& s) {
  ar("memory", s.memory);
  ar("probability", s.probability);
  ar("next", s.next);
}

// Thousands of small states are packed into a few lists: HDF5 is slow with many
// small datasets.
void fields(Archive& ar, Vlmm& v) {
  std::vector<std::int64_t> lengths, memories, next, counts;
  std::vector<double> probabilities;
  std::vector<std::string> labels;
  for (const auto& s : v.states) {
    lengths.push_back(static_cast<std::int64_t>(s.memory.size()));
    memories.insert(memories.end(), s.memory.begin(), s.memory.end());
    next.insert(next.end(), s.next.begin(), s.next.end());
    probabilities.insert(probabilities.end(), s.probability.begin(), s.probability.end());
  }
  ar("order", v.order);
  ar("repeating", v.repeating);
  ar("alphabet", v.alphabet);
  ar("lengths", lengths);
  ar("memories", memories);
  ar("next", next);
  ar("probabilities", probabilities);
  for (const auto& [name, map] : {std::pair("occupancy", &v.occupancy), std::pair("windows", &v.windows)}) {
    labels.clear();
    counts.clear();
    for (const auto& [label, count] : *map) labels.push_back(label), counts.push_back(count);
    ar(std::string(name) + "_labels", labels);
    ar(name, counts);
    if (!ar.loading()) continue;
    map->clear();
    for (std::size_t i = 0; i < labels.size(); ++i) (*map)[labels[i]] = counts.at(i);
  }
  if (!ar.loading()) return;
  v.states.clear();
  const auto symbols = static_cast<std::ptrdiff_t>(v.alphabet.size());
  std::ptrdiff_t at = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const auto row = static_cast<std::ptrdiff_t>(i) * symbols;
    v.states.push_back({{memories.begin() + at, memories.begin() + at + lengths[i]},
                        {probabilities.begin() + row, probabilities.begin() + row + symbols},
                        {next.begin() + row, next.begin() + row + symbols}});
    at += lengths[i];
  }
}

}  // namespace talkgraph
