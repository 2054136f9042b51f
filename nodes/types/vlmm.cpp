#include "nodes/types/vlmm.h"

#include <algorithm>
#include <cmath>

#include "nodes/types/stored_model.h"

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

std::string last_phone(const std::string& label) { return label.substr(label.rfind('-') + 1); }

std::int64_t frames_read(const Vlmm& v, std::size_t state) {
  const auto& s = v.states[state];
  const std::string memory = s.memory.empty() ? "" : memory_label(v, s.memory) + "-";
  std::int64_t frames = 0;
  for (std::size_t i = 0; i < v.alphabet.size(); ++i) {
    const auto found = v.occupancy.find(memory + v.alphabet[i]);
    // Without a transition the label is the symbol alone, as if read in no memory.
    if (found != v.occupancy.end() && (s.next[i] >= 0 || memory.empty())) frames += found->second;
  }
  return frames;
}

std::string memory_label(const Vlmm& v, const std::vector<std::int64_t>& memory) {
  std::string label;
  for (const auto s : memory) label += (label.empty() ? "" : "-") + v.alphabet[static_cast<std::size_t>(s)];
  return label;
}

namespace {

using Memory = std::vector<std::int64_t>;

const StoredModel stored("model of contexts");

/// Thousands of small states as a few lists: HDF5 is slow with many small datasets.
struct PackedStates {
  std::vector<std::int64_t> lengths, memories, next;
  std::vector<double> probabilities, ends;
};

PackedStates packed(const std::vector<Vlmm::State>& states) {
  PackedStates p;
  for (const auto& s : states) {
    p.lengths.push_back(std::ssize(s.memory));
    p.memories.insert(p.memories.end(), s.memory.begin(), s.memory.end());
    p.next.insert(p.next.end(), s.next.begin(), s.next.end());
    p.probabilities.insert(p.probabilities.end(), s.probability.begin(), s.probability.end());
    p.ends.push_back(s.end);
  }
  return p;
}

std::vector<Vlmm::State> unpacked(const PackedStates& p, std::size_t symbols) {
  stored.require(p.next.size() == p.lengths.size() * symbols, "next", "is not one a state and symbol");
  stored.require(p.probabilities.size() == p.next.size(), "probabilities", "are not one a state and symbol");
  stored.require(p.ends.size() == p.lengths.size(), "ends", "are not one a state");
  std::vector<Vlmm::State> states;
  auto memory = p.memories.begin();
  auto next = p.next.begin();
  auto probability = p.probabilities.begin();
  const auto row = static_cast<std::ptrdiff_t>(symbols);
  for (const auto length : p.lengths) {
    stored.require(length >= 0 && length <= p.memories.end() - memory, "lengths", "are not those of the memories");
    states.push_back(
        {{memory, memory + length}, {probability, probability + row}, {next, next + row}, p.ends[states.size()]});
    memory += length, next += row, probability += row;
  }
  stored.require(memory == p.memories.end(), "memories", "are longer than their lengths together");
  return states;
}

void counts(Archive& ar, const std::string& name, std::map<std::string, std::int64_t>& map) {
  std::vector<std::string> labels;
  std::vector<std::int64_t> counts;
  for (const auto& [label, count] : map) labels.push_back(label), counts.push_back(count);
  ar(name + "_labels", labels);
  ar(name, counts);
  if (!ar.loading()) return;
  stored.require(labels.size() == counts.size(), name, "is not one a label");
  map.clear();
  for (std::size_t i = 0; i < labels.size(); ++i) map[labels[i]] = counts[i];
}

bool ends_with(const Memory& memory, std::int64_t symbol, const Memory& end) {
  return end.empty() || (end.back() == symbol && end.size() <= memory.size() + 1 &&
                         std::equal(end.rbegin() + 1, end.rend(), memory.rbegin()));
}

void check_memory(const Vlmm& v, const Memory& memory) {
  stored.require(std::ssize(memory) <= v.order, "order", "is shorter than a memory");
  for (const auto s : memory)
    stored.require(s >= 0 && s < std::ssize(v.alphabet), "memories", "name no symbol of the alphabet");
}

void check_transitions(const Vlmm& v, const Vlmm::State& state) {
  const auto symbols = std::ssize(v.alphabet), states = std::ssize(v.states);
  bool leads = true, likely = true;
  double sum = 0;
  for (std::int64_t s = 0; s < symbols; ++s) {
    const auto next = state.next[static_cast<std::size_t>(s)];
    const double p = state.probability[static_cast<std::size_t>(s)];
    leads = leads && next >= -1 && next < states &&
            (next < 0 || ends_with(state.memory, s, v.states[static_cast<std::size_t>(next)].memory));
    likely = likely && p >= 0 && (p > 0) == (next >= 0);
    sum += p;
  }
  stored.require(state.end >= 0 && state.end <= 1, "ends", "are no shares");
  stored.require(leads, "next", "leads to no state, or to one of another context");
  stored.require(likely && (sum == 0 || std::abs(sum - 1) < 1e-9), "probabilities", "are not those of the transitions");
}

void check(const Vlmm& v) {
  stored.require(!v.states.empty() && v.states[0].memory.empty(), "memories", "do not begin with the empty one");
  stored.sorted("alphabet", v.alphabet);
  for (const auto& state : v.states) check_memory(v, state.memory);
  for (const auto& state : v.states) check_transitions(v, state);
  for (const auto& symbol : v.alphabet) stored.require(v.windows.contains(symbol), "windows", "lack a symbol");
  for (const auto& [name, map] : {std::pair("occupancy", &v.occupancy), std::pair("windows", &v.windows)})
    for (const auto& [label, count] : *map) {
      stored.require(count >= 0, name, "has a count below 0");
      for (const auto& symbol : label_phones(label))
        stored.require(std::binary_search(v.alphabet.begin(), v.alphabet.end(), symbol), name,
                       "names no symbol of the alphabet");
    }
}

}  // namespace

void fields(Archive& ar, Vlmm& v) {
  PackedStates states = packed(v.states);
  ar("order", v.order);
  ar("repeating", v.repeating);
  ar("visemes", v.visemes);
  ar("alphabet", v.alphabet);
  ar("lengths", states.lengths);
  ar("memories", states.memories);
  ar("next", states.next);
  ar("probabilities", states.probabilities);
  ar("ends", states.ends);
  counts(ar, "occupancy", v.occupancy);
  counts(ar, "windows", v.windows);
  ar("min_windows", v.min_windows);
  if (!ar.loading()) return;
  v.states = unpacked(states, v.alphabet.size());
  check(v);
}

}  // namespace talkgraph
