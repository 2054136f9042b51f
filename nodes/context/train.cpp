#include "nodes/context/train.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "nodes/context/automaton.h"

namespace talkgraph {
namespace {

using Symbols = std::vector<std::int64_t>;

/// Counts of all strings up to a length in a set of streams.
class PrefixTree {
 public:
  explicit PrefixTree(std::size_t symbols) : symbols_(symbols), counts_(1, 0) {}

  void add(const Symbols& stream, std::size_t longest) {
    for (std::size_t start = 0; start < stream.size(); ++start) {
      ++counts_[0];
      std::int64_t node = 0;
      for (std::size_t i = start; i < std::min(stream.size(), start + longest); ++i) {
        node = child(node, stream[i]);
        ++counts_[static_cast<std::size_t>(node)];
      }
    }
  }
  /// Of the empty string: all frames.
  std::int64_t count(const Symbols& string) const {
    std::int64_t node = 0;
    for (const auto s : string) {
      const auto it = children_.find(key(node, s));
      if (it == children_.end()) return 0;
      node = it->second;
    }
    return counts_[static_cast<std::size_t>(node)];
  }
  /// p(σ | string) for every σ; all zero if nothing ever followed.
  std::vector<double> next(const Symbols& string) const {
    std::vector<double> p(symbols_);
    Symbols longer = string;
    longer.push_back(0);
    double sum = 0;
    for (std::size_t s = 0; s < symbols_; ++s) {
      longer.back() = static_cast<std::int64_t>(s);
      sum += p[s] = static_cast<double>(count(longer));
    }
    if (sum > 0)
      for (auto& x : p) x /= sum;
    return p;
  }

 private:
  std::int64_t key(std::int64_t node, std::int64_t s) const { return node * static_cast<std::int64_t>(symbols_) + s; }
  std::int64_t child(std::int64_t node, std::int64_t s) {
    const auto [it, fresh] = children_.try_emplace(key(node, s), static_cast<std::int64_t>(counts_.size()));
    if (fresh) counts_.push_back(0);
    return it->second;
  }

  std::size_t symbols_;
  std::vector<std::int64_t> counts_;
  std::unordered_map<std::int64_t, std::int64_t> children_;
};

/// Σ p ln(p / q) over the symbols seen after the longer memory.
double divergence(const std::vector<double>& p, const std::vector<double>& q) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p[i] > 0) sum += p[i] * std::log(p[i] / q[i]);
  return sum;
}

/// The memories worth keeping, closed under taking suffixes.
std::set<Symbols> memories(const PrefixTree& tree, std::size_t symbols, const ContextTrain& node) {
  const auto total = static_cast<double>(tree.count({}));
  std::set<Symbols> kept = {{}};
  std::deque<Symbols> candidates;
  const auto extend = [&](const Symbols& w) {
    Symbols longer(1);
    longer.insert(longer.end(), w.begin(), w.end());
    for (std::size_t s = 0; s < symbols; ++s) {
      longer[0] = static_cast<std::int64_t>(s);
      if (static_cast<double>(tree.count(longer)) / total > node.prune) candidates.push_back(longer);
    }
  };
  extend({});
  for (; !candidates.empty(); candidates.pop_front()) {
    const Symbols& w = candidates.front();
    const Symbols suffix(w.begin() + 1, w.end());
    const double share = static_cast<double>(tree.count(w)) / total;
    if (share * divergence(tree.next(w), tree.next(suffix)) >= node.keep)
      for (auto from = w.begin(); from != w.end(); ++from) kept.insert(Symbols(from, w.end()));
    if (static_cast<int>(w.size()) < node.order) extend(Symbols(w));
  }
  return kept;
}

}  // namespace

Vlmm ContextTrain::operator()(const Collected<FrameLabels>& labels) const {
  std::set<std::string> phones;
  for (std::size_t i = 0; i < labels.size(); ++i) phones.insert(labels[i].labels.begin(), labels[i].labels.end());
  if (phones.empty())
    throw std::runtime_error("contexts cannot be learnt from no frame: is the training selection empty?");

  Vlmm v;
  v.order = order;
  v.min_windows = min_windows;
  v.alphabet.assign(phones.begin(), phones.end());
  const auto symbol = [&](const std::string& phone) {
    return std::lower_bound(v.alphabet.begin(), v.alphabet.end(), phone) - v.alphabet.begin();
  };
  PrefixTree tree(v.alphabet.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Symbols stream;
    for (const auto& phone : labels[i].labels) stream.push_back(symbol(phone));
    tree.add(stream, static_cast<std::size_t>(order) + 1);
  }
  for (const auto& memory : memories(tree, v.alphabet.size(), *this))
    v.states.push_back({memory, tree.next(memory), {}});
  connect_states(v);

  for (std::size_t i = 0; i < labels.size(); ++i)
    for (auto& label : context_labels(v, labels[i].labels)) ++v.occupancy[label];
  for (const auto& phone : v.alphabet) v.occupancy.try_emplace(phone, 0);
  // Windows of a label and of the suffixes it may be mapped to.
  for (const auto& [label, count] : v.occupancy) {
    const auto parts = label_phones(label);
    Symbols string;
    for (const auto& phone : parts) string.push_back(symbol(phone));
    for (std::size_t from = 0; from < parts.size(); ++from)
      v.windows[join_phones(parts, from, parts.size())] =
          tree.count(Symbols(string.begin() + static_cast<std::ptrdiff_t>(from), string.end()));
  }
  return v;
}

void describe(Description<ContextTrain>& d) {
  d.type("context.train")
      .summary("learns phonetic contexts: a variable length Markov model of phones per frame")
      .stored();
  d.source("Thesis §5.2.1, Algorithm 3");
  d.input("labels", "phones at the video rate").output("vlmm");
  d.param("order", &ContextTrain::order).within(0, 50).unit("frames").doc("longest memory");
  d.param("prune", &ContextTrain::prune)
      .within(0, 1)
      .doc("strings in at most this share of the frames are not looked at");
  d.param("keep", &ContextTrain::keep)
      .at_least(0)
      .unit("nats")
      .doc("least gain in prediction for which a memory is kept");
  d.param("min_windows", &ContextTrain::min_windows)
      .at_least(1)
      .doc("labels with fewer training windows are mapped to a suffix");
}

}  // namespace talkgraph
