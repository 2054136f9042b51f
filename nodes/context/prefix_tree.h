#pragma once

#include <cstdint>
#include <vector>

namespace talkgraph {

/// Counts of all strings of at most `depth` symbols in a set of streams. A node
/// is a string; node 0 is the empty one, whose count is that of all symbols.
class PrefixTree {
 public:
  struct Node {
    std::int64_t symbol = -1;  ///< last of the string
    int parent = -1;           ///< the string without its last symbol
    int suffix = -1;           ///< the string without its first symbol
    int first_child = -1, sibling = -1;
    int length = 0;
    std::int64_t count = 0;
  };

  explicit PrefixTree(int depth) : depth_(depth), nodes_(1) {}

  void add(const std::vector<std::int64_t>& stream);

  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& operator[](int node) const { return nodes_[static_cast<std::size_t>(node)]; }
  /// The node of a string one symbol longer, -1 if it was never seen.
  int child(int node, std::int64_t symbol) const;
  std::vector<std::int64_t> string(int node) const;

 private:
  int make_child(int node, std::int64_t symbol, int suffix);

  int depth_;
  std::vector<Node> nodes_;
};

}  // namespace talkgraph
