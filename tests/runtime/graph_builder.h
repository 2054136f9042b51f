#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "graph/graph.h"

namespace talkgraph {

/// Puts a checked graph together by hand, as loading would.
class GraphBuilder {
 public:
  explicit GraphBuilder(const Registry& registry) : registry_(registry) { graph.name = "test.json"; }

  /// A source of an input: a port, or several by name for a collecting port.
  struct In {
    In() = default;
    In(Graph::Port p) : sources{p} {}
    In(int node) : sources{{node, 0}} {}
    In(std::vector<std::pair<std::string, Graph::Port>> named) {
      for (auto& [name, port] : named) names.push_back(name), sources.push_back(port);
    }
    std::vector<Graph::Port> sources;
    std::vector<std::string> names;
  };

  /// Adds a node whose ports are wired in their order; returns its index.
  int add(const std::string& name, const std::string& type, std::vector<In> inputs = {}, const Json& params = {}) {
    Graph::Node node;
    node.name = name;
    node.type = registry_.find(type);
    if (!node.type) throw std::logic_error("no node type " + type);
    node.place = {std::make_shared<SourceText>(SourceText{"test.json", ""}), static_cast<int>(graph.nodes.size()) + 1,
                  5};
    Diagnostics diagnostics;
    const auto json = located(params.is_null() ? Json::object() : params, node.place);
    node.functor = node.type->make(&json, node.place, name, diagnostics);
    if (!diagnostics.ok()) throw std::logic_error(diagnostics.str());
    inputs.resize(node.type->inputs.size());
    for (std::size_t p = 0; p < inputs.size(); ++p) {
      Graph::Wire wire;
      wire.sources = inputs[p].sources;
      wire.names = inputs[p].names;
      const bool collects = node.type->inputs[p].kind == PortSpec::Kind::collected;
      for (const auto& source : wire.sources) {
        const int domain = domain_of(source);
        if (collects)
          wire.gathers_stream = domain >= 0;
        else if (domain >= 0)
          node.domain = domain;
      }
      node.inputs.push_back(std::move(wire));
    }
    graph.nodes.push_back(std::move(node));
    return static_cast<int>(graph.nodes.size()) - 1;
  }
  void output(const std::string& name, Graph::Port source) { graph.outputs.push_back({name, source}); }
  void output(const std::string& name, int node) { output(name, Graph::Port{node, 0}); }

  int domain_of(const Graph::Port& p) const {
    return graph.nodes[static_cast<std::size_t>(p.node)].output_domain(p.node);
  }

  Graph graph;

 private:
  const Registry& registry_;
};

}  // namespace talkgraph
