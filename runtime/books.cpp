#include "runtime/books.h"

#include <fmt/format.h>

#include <stdexcept>

#include "runtime/plan.h"

namespace talkgraph {
namespace {

[[noreturn]] void unbalanced(const Graph::Node& node, const std::string& what) {
  throw std::logic_error(
      fmt::format("internal error: the books of node \"{}\" do not balance: {}; please report this", node.name, what));
}

}  // namespace

void check_books(const Graph& graph, const std::vector<NodeStats>& stats) {
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    const auto& node = graph.nodes[n];
    const auto& books = stats[n];
    // For a source there is no other count than its own.
    const auto items = node.type->makes_stream ? books.calls
                       : node.domain < 0       ? 1
                                               : stats[static_cast<std::size_t>(node.domain)].calls;
    const auto done = books.calls + books.skipped + books.loaded + books.unneeded;
    if (!node.type->makes_stream && done != items) unbalanced(node, fmt::format("{} items of {}", done, items));
    for (std::size_t p = 0; p < books.out.size(); ++p)
      if (books.out[p].items != items)
        unbalanced(node, fmt::format("output \"{}\" sent {} items of {}", node.type->outputs[p].name,
                                     books.out[p].items, items));
    std::vector<PortCount> sent(node.inputs.size());
    for_each_source(graph, static_cast<int>(n), [&](std::size_t p, Graph::Port source, Way) {
      const auto& out = stats[static_cast<std::size_t>(source.node)].out[static_cast<std::size_t>(source.port)];
      sent[p].items += out.items;
      sent[p].values += out.values;
    });
    for (std::size_t p = 0; p < sent.size(); ++p)
      if (sent[p] != books.in[p])
        unbalanced(node, fmt::format("input \"{}\" got {} items with {} values, sent were {} with {}",
                                     node.type->inputs[p].name, books.in[p].items, books.in[p].values, sent[p].items,
                                     sent[p].values));
  }
}

}  // namespace talkgraph
