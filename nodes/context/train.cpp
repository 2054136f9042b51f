#include "nodes/context/train.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "nodes/context/automaton.h"
#include "nodes/context/prefix_tree.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

using Symbols = std::vector<std::int64_t>;

/// The memories worth keeping and the automaton of them.
class Learner {
 public:
  Learner(const PrefixTree& tree, const std::vector<std::string>& alphabet, double prune, double keep)
      : tree_(tree), alphabet_(alphabet), total_(static_cast<double>(tree[0].count)), prune_(prune), keep_(keep) {}

  std::vector<Vlmm::State> states(int order) {
    state_.assign(tree_.nodes().size(), -1);
    state_[0] = 0;
    for (int node = 1; node < static_cast<int>(tree_.nodes().size()); ++node)
      if (tree_[node].length <= order && survives(node) && !is_pause(node) && gain(node) >= keep_)
        for (int n = node; n > 0; n = tree_[n].suffix) state_[static_cast<std::size_t>(n)] = 0;
    return connected(sorted_memories());
  }

 private:
  double share(int node) const { return count(node) / total_; }
  bool survives(int node) const { return share(node) > prune_; }
  bool is_pause(int node) const { return is_end_pause(alphabet_[static_cast<std::size_t>(tree_[node].symbol)]); }

  template <class Visit>
  void each_branch(int node, Visit visit) const {
    for (int c = tree_[node].first_child; c >= 0; c = tree_[c].sibling)
      if (survives(c)) visit(c);
  }
  double count(int node) const { return static_cast<double>(tree_[node].count); }
  /// Over the branches that were not pruned.
  double followed(int node) const {
    double sum = 0;
    each_branch(node, [&](int c) { sum += count(c); });
    return sum;
  }
  /// p(w) Σ p(σ|w) ln (p(σ|w) / p(σ|v)) of a string w and its suffix v.
  double gain(int node) const {
    const double longer = followed(node), shorter = followed(tree_[node].suffix);
    double sum = 0;
    each_branch(node, [&](int c) {
      const double p = count(c) / longer;
      sum += p * std::log(p / (count(tree_[c].suffix) / shorter));
    });
    return share(node) * sum;
  }
  double end(int node) const {
    std::int64_t inside = 0;
    for (int c = tree_[node].first_child; c >= 0; c = tree_[c].sibling) inside += tree_[c].count;
    return 1 - static_cast<double>(inside) / count(node);
  }

  std::vector<int> sorted_memories() const {
    std::vector<std::pair<Symbols, int>> memories;
    for (std::size_t node = 0; node < state_.size(); ++node)
      if (state_[node] >= 0) memories.emplace_back(tree_.string(static_cast<int>(node)), static_cast<int>(node));
    std::sort(memories.begin(), memories.end());
    std::vector<int> nodes;
    for (const auto& memory : memories) nodes.push_back(memory.second);
    return nodes;
  }
  std::vector<Vlmm::State> connected(const std::vector<int>& nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      state_[static_cast<std::size_t>(nodes[i])] = static_cast<std::int64_t>(i);
    std::vector<Vlmm::State> states;
    for (const int node : nodes) {
      Vlmm::State state{tree_.string(node), std::vector<double>(alphabet_.size()), Symbols(alphabet_.size(), -1),
                        end(node)};
      const double all = followed(node);
      each_branch(node, [&](int c) {
        int longest = c;
        while (state_[static_cast<std::size_t>(longest)] < 0) longest = tree_[longest].suffix;
        const auto symbol = static_cast<std::size_t>(tree_[c].symbol);
        state.probability[symbol] = count(c) / all;
        state.next[symbol] = state_[static_cast<std::size_t>(longest)];
      });
      states.push_back(std::move(state));
    }
    return states;
  }

  const PrefixTree& tree_;
  const std::vector<std::string>& alphabet_;
  double total_, prune_, keep_;
  std::vector<std::int64_t> state_;  // of each node of the tree, -1 if its string is no memory
};

/// Training streams as units, and as indices into the alphabet, pauses at their ends by themselves.
struct Streams {
  std::vector<std::string> alphabet;
  std::vector<std::vector<Unit>> units;
  std::vector<Symbols> symbols;
};

/// Throws if they cannot be symbols.
void check(const std::set<std::string>& phones, bool visemes) {
  if (phones.empty())
    throw std::runtime_error("contexts cannot be learnt from no frame: is the training selection empty?");
  for (const auto& phone : phones) {
    if (visemes && !is_phone(phone))
      throw std::runtime_error("\"" + phone + "\" is neither a CMU nor a BEEP phone, so it has no viseme");
  }
}

Streams read(const Collected<FrameLabels>& labels, const Vlmm& vlmm) {
  Streams streams;
  std::set<std::string> phones, alphabet;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    phones.insert(labels[i].labels.begin(), labels[i].labels.end());
    streams.units.push_back(units(vlmm, labels[i].labels));
    for (const auto& unit : streams.units.back()) alphabet.insert(unit.symbol);
  }
  check(phones, vlmm.visemes);
  streams.alphabet.assign(alphabet.begin(), alphabet.end());
  for (const auto& stream : streams.units) {
    Symbols utterance;
    for (const auto& unit : stream) {
      const auto symbol =
          std::lower_bound(streams.alphabet.begin(), streams.alphabet.end(), unit.symbol) - streams.alphabet.begin();
      if (is_end_pause(unit.symbol))
        streams.symbols.push_back({symbol});
      else
        utterance.push_back(symbol);
    }
    streams.symbols.push_back(std::move(utterance));
  }
  return streams;
}

std::int64_t windows_of(const PrefixTree& tree, const Vlmm& v, const std::vector<std::string>& phones,
                        std::size_t from) {
  int node = 0;
  for (std::size_t i = from; i < phones.size() && node >= 0; ++i) node = tree.child(node, index_of(v, phones[i]));
  return node < 0 ? 0 : tree[node].count;
}

}  // namespace

Vlmm ContextTrain::operator()(const Collected<FrameLabels>& labels) const {
  Vlmm v;
  v.order = order;
  v.repeating = repeating;
  v.visemes = symbols == SymbolKind::visemes;
  v.min_windows = min_windows;
  const Streams streams = read(labels, v);
  v.alphabet = streams.alphabet;
  PrefixTree tree(order + 1);
  for (const auto& stream : streams.symbols) tree.add(stream);
  v.states = Learner(tree, v.alphabet, prune, keep).states(order);
  for (const auto& stream : streams.units) {
    AutomatonReader reader(v);
    for (const auto& unit : stream) v.occupancy[reader.read(unit.symbol).label] += unit.length;
  }
  for (const auto& phone : v.alphabet) v.windows[phone] = windows_of(tree, v, {phone}, 0);
  for (const auto& [label, frames] : v.occupancy) {
    const auto phones = label_phones(label);
    for (std::size_t from = 0; from < phones.size(); ++from) {
      const auto count = windows_of(tree, v, phones, from);
      if (count < min_windows) continue;
      v.windows[join_phones(phones, from, phones.size())] = count;
      break;
    }
  }
  return v;
}

void describe(Description<ContextTrain>& d) {
  d.type("context.train").version(3).stored();
  d.summary("learns phonetic contexts: a variable length Markov model of phones");
  d.source("Thesis §5.2.1, Algorithm 3");
  d.input("labels", "phones at the video rate").output("vlmm", "the contexts");
  d.param("order", &ContextTrain::order).within(0, 50).unit("phones").doc("longest memory");
  d.param("prune", &ContextTrain::prune).within(0, 1).doc("strings in at most this share of the stream are pruned");
  d.param("keep", &ContextTrain::keep)
      .at_least(0)
      .unit("nats")
      .doc("least gain in prediction for which a memory is kept");
  d.param("min_windows", &ContextTrain::min_windows)
      .at_least(1)
      .doc("labels with fewer training windows are mapped to a suffix, phones to another of their viseme");
  d.param("symbols", &ContextTrain::symbols).doc("what contexts are of; decode, segment and windows follow the model");
  d.param("repeating", &ContextTrain::repeating).doc("a symbol a frame; false: a symbol a run of equal frames");
}

}  // namespace talkgraph
