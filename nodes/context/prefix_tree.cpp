#include "nodes/context/prefix_tree.h"

#include <algorithm>

namespace talkgraph {

void PrefixTree::add(const std::vector<std::int64_t>& stream) {
  nodes_[0].count += static_cast<std::int64_t>(stream.size());
  std::vector<int> ending = {0}, before;  // nodes of the strings that end here, the shortest first
  for (const auto symbol : stream) {
    std::swap(ending, before);
    ending = {0};
    for (std::size_t i = 0; i < before.size() && static_cast<int>(i) < depth_; ++i) {
      ending.push_back(make_child(before[i], symbol, ending.back()));
      ++nodes_[static_cast<std::size_t>(ending.back())].count;
    }
  }
}

int PrefixTree::child(int node, std::int64_t symbol) const {
  int at = (*this)[node].first_child;
  while (at >= 0 && (*this)[at].symbol != symbol) at = (*this)[at].sibling;
  return at;
}

int PrefixTree::make_child(int node, std::int64_t symbol, int suffix) {
  if (const int found = child(node, symbol); found >= 0) return found;
  const int made = static_cast<int>(nodes_.size());
  Node& parent = nodes_[static_cast<std::size_t>(node)];
  const Node fresh{symbol, node, suffix, -1, parent.first_child, parent.length + 1, 0};
  parent.first_child = made;
  nodes_.push_back(fresh);
  return made;
}

std::vector<std::int64_t> PrefixTree::string(int node) const {
  std::vector<std::int64_t> symbols;
  for (; node > 0; node = (*this)[node].parent) symbols.push_back((*this)[node].symbol);
  std::reverse(symbols.begin(), symbols.end());
  return symbols;
}

}  // namespace talkgraph
