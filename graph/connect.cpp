#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "graph/draft.h"

namespace talkgraph::detail {
namespace {

using Kind = LocatedJson::Kind;

/// A source of a wire, or nothing where an optional graph input is left open.
struct Source {
  bool ok = false;
  std::optional<Graph::Port> port;
};

class Connector {
 public:
  Connector(Draft& draft, const Registry& registry, Diagnostics& diagnostics)
      : draft_(draft), registry_(registry), diagnostics_(diagnostics) {}

  std::optional<Graph> run() {
    for (const auto& made : draft_.nodes) nodes_.push_back({made.name, made.type, made.functor, {}, -1, made.place});
    unsure_.assign(nodes_.size(), false);
    for (std::size_t i = 0; i < nodes_.size(); ++i) wire(i);
    const auto outputs = wire_outputs();
    sort();
    find_domains();
    if (!diagnostics_.ok()) return {};
    Graph graph = assemble(outputs);
    if (!graph.nodes.empty()) return graph;
    diagnostics_.error(
        draft_.root->json.place,
        "nothing here would run: name what the graph gives in \"outputs\", or add a node that writes a file");
    return {};
  }

 private:
  void wire(std::size_t index) {
    const auto& made = draft_.nodes[index];
    nodes_[index].inputs.resize(made.type->inputs.size());
    if (!made.scope) return;
    const auto* in = made.json->find("in");
    check_port_names(made, in);
    for (std::size_t p = 0; p < made.type->inputs.size(); ++p) {
      const auto& spec = made.type->inputs[p];
      const auto* given = in ? in->value.find(spec.name) : nullptr;
      if (!given || given->value.is(Kind::null)) {
        if (spec.kind != PortSpec::Kind::optional) {
          diagnostics_.error(made.place, fmt::format("node \"{}\": input \"{}\" ({}) is not wired", made.name,
                                                     spec.name, spec.type.name));
          unsure_[index] = true;
        }
        continue;
      }
      const auto complaints = diagnostics_.messages().size();
      auto& wire = nodes_[index].inputs[p] = wire_port(made, spec, given->value);
      const bool open = wire.sources.empty() && spec.kind == PortSpec::Kind::item;
      if (open || diagnostics_.messages().size() > complaints) unsure_[index] = true;
    }
  }

  void check_port_names(const Draft::Made& made, const LocatedJson::Member* in) {
    if (!in) return;
    std::vector<std::string> names;
    for (const auto& spec : made.type->inputs) names.push_back(spec.name);
    for (const auto& m : in->value.members)
      if (std::find(names.begin(), names.end(), m.key) == names.end())
        diagnostics_.error(m.key_place, fmt::format("node \"{}\": {} has no input \"{}\"{}", made.name, made.type->name,
                                                    m.key, did_you_mean(m.key, names)));
  }

  Graph::Wire wire_port(const Draft::Made& made, const PortSpec& spec, const LocatedJson& json) {
    Graph::Wire wire;
    const std::string subject = fmt::format("node \"{}\": input \"{}\"", made.name, spec.name);
    if (json.is(Kind::text)) {
      if (add_source(made, spec, subject, json, wire)) wire.gathers_stream = spec.kind == PortSpec::Kind::collected;
    } else if (json.is(Kind::object) && spec.kind == PortSpec::Kind::collected) {
      for (const auto& m : json.members)
        if (add_source(made, spec, subject, m.value, wire)) wire.names.push_back(m.key);
    } else {
      diagnostics_.error(
          json.place,
          fmt::format("{} must name its source as \"node.port\"{}, got {}", subject,
                      spec.kind == PortSpec::Kind::collected ? ", or several single values as an object" : "",
                      json.kind_name()));
    }
    return wire;
  }

  bool add_source(const Draft::Made& made, const PortSpec& spec, const std::string& subject, const LocatedJson& json,
                  Graph::Wire& wire) {
    const Source source = resolve(*made.scope, json, subject, 0);
    if (!source.ok) return false;
    if (!source.port) {
      if (spec.kind != PortSpec::Kind::optional)
        diagnostics_.error(json.place, fmt::format("{} needs a value, but this graph input is not wired", subject));
      return false;
    }
    const auto& type = port_spec(*source.port).type;
    if (spec.type != any_type && type != spec.type) {
      diagnostics_.error(json.place, fmt::format("{} takes {}, but \"{}\" gives {}", subject, spec.type.name,
                                                 port_name(*source.port), type.name));
      return false;
    }
    wire.sources.push_back(*source.port);
    return true;
  }

  const PortSpec& port_spec(const Graph::Port& p) const {
    return nodes_[static_cast<std::size_t>(p.node)].type->outputs[static_cast<std::size_t>(p.port)];
  }
  std::string port_name(const Graph::Port& p) const {
    return nodes_[static_cast<std::size_t>(p.node)].name + "." + port_spec(p).name;
  }

  /// Finds what "node.port" means in a scope.
  Source resolve(const Scope& scope, const LocatedJson& json, const std::string& subject, int depth) {
    if (!json.is(Kind::text)) {
      diagnostics_.error(json.place, fmt::format("{} must name its source as \"node.port\"", subject));
      return {};
    }
    if (depth > 100) {
      diagnostics_.error(json.place, subject + " is wired to itself through the inputs of graphs");
      return {};
    }
    const auto name = json.scalar.get<std::string>();
    const auto dot = name.rfind('.');
    const std::string node = name.substr(0, dot), port = dot == std::string::npos ? "" : name.substr(dot + 1);
    if (node == "inputs") return resolve_input(scope, port, json, subject, depth);
    const auto it = scope.entries.find(node);
    if (it == scope.entries.end()) {
      std::vector<std::string> known;
      for (const auto& [key, entry] : scope.entries) known.push_back(key);
      diagnostics_.error(json.place,
                         fmt::format("{}: there is no node \"{}\"{}", subject, node, did_you_mean(node, known)));
      return {};
    }
    if (it->second.graph) return resolve_graph_output(*it->second.graph, node, port, json, subject, depth);
    if (it->second.node < 0) return {};  // its type was refused already
    const int index = it->second.node;
    const auto& outputs = nodes_[static_cast<std::size_t>(index)].type->outputs;
    std::vector<std::string> names;
    for (const auto& o : outputs) names.push_back(o.name);
    const auto at = port.empty() && outputs.size() == 1 ? names.begin() : std::find(names.begin(), names.end(), port);
    if (at != names.end()) return {true, Graph::Port{index, static_cast<int>(at - names.begin())}};
    complain_output(node, port, names, json, subject);
    return {};
  }

  Source resolve_input(const Scope& scope, const std::string& name, const LocatedJson& json, const std::string& subject,
                       int depth) {
    std::vector<std::string> names;
    for (const auto& m : members_of(scope.json, "inputs")) names.push_back(m.key);
    const auto* declared = scope.json.find("inputs");
    const auto* input = declared ? declared->value.find(name) : nullptr;
    if (!input) {
      diagnostics_.error(json.place,
                         fmt::format("{}: the graph has no input \"{}\"{}", subject, name, did_you_mean(name, names)));
      return {};
    }
    if (!scope.parent) return root_input(name);
    const auto* given = scope.in ? scope.in->find(name) : nullptr;
    if (!given || given->value.is(Kind::null)) return {true, {}};
    const Source source = resolve(*scope.parent, given->value, subject, depth + 1);
    if (source.port) check_declared(*input, *source.port, given->value);
    return source;
  }

  /// A graph's declared input type against what its user wired to it.
  void check_declared(const LocatedJson::Member& input, const Graph::Port& port, const LocatedJson& given) {
    Diagnostics ignored;  // the declaration itself was checked when the graph was opened
    const auto declared = declared_input(input.value, registry_, ignored);
    if (!declared || declared->type == port_spec(port).type.name) return;
    const std::string text = fmt::format("graph input \"{}\" takes {}, but \"{}\" gives {}", input.key, declared->type,
                                         port_name(port), port_spec(port).type.name);
    for (const auto& m : diagnostics_.messages())
      if (m.text == text) return;
    diagnostics_.error(given.place, text);
  }

  Source root_input(const std::string& name) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (draft_.nodes[i].scope) continue;
      const auto& outputs = nodes_[i].type->outputs;
      for (std::size_t p = 0; p < outputs.size(); ++p)
        if (outputs[p].name == name) return {true, Graph::Port{static_cast<int>(i), static_cast<int>(p)}};
    }
    return {};
  }

  Source resolve_graph_output(const Scope& graph, const std::string& node, const std::string& port,
                              const LocatedJson& json, const std::string& subject, int depth) {
    const auto& outputs = members_of(graph.json, "outputs");
    std::vector<std::string> names;
    for (const auto& o : outputs) names.push_back(o.key);
    const LocatedJson* inner = nullptr;
    for (const auto& o : outputs)
      if (o.key == port || (port.empty() && outputs.size() == 1)) inner = &o.value;
    if (inner) return resolve(graph, *inner, subject, depth + 1);
    complain_output(node, port, names, json, subject);
    return {};
  }

  void complain_output(const std::string& node, const std::string& port, const std::vector<std::string>& names,
                       const LocatedJson& json, const std::string& subject) {
    diagnostics_.error(json.place, port.empty() ? fmt::format("{}: \"{}\" has several outputs: say which ({})", subject,
                                                              node, fmt::join(names, ", "))
                                                : fmt::format("{}: node \"{}\" has no output \"{}\"{}", subject, node,
                                                              port, did_you_mean(port, names)));
  }

  std::vector<Graph::Output> wire_outputs() {
    std::vector<Graph::Output> outputs;
    if (!draft_.root) return outputs;
    for (const auto& m : members_of(draft_.root->json, "outputs")) {
      const Source source = resolve(*draft_.root, m.value, fmt::format("output \"{}\"", m.key), 0);
      if (source.port) outputs.push_back({m.key, *source.port});
    }
    return outputs;
  }

  /// Depth-first topological order, in file order where that is free; reports cycles.
  void sort() {
    enum class State { unseen, open, done };
    std::vector<State> state(nodes_.size(), State::unseen);
    std::vector<int> path;
    const std::function<void(int)> visit = [&](int i) {
      auto& s = state[static_cast<std::size_t>(i)];
      if (s == State::done) return;
      if (s == State::open) return complain_cycle(std::find(path.begin(), path.end(), i), path.end());
      s = State::open;
      path.push_back(i);
      for (const auto& wire : nodes_[static_cast<std::size_t>(i)].inputs)
        for (const auto& source : wire.sources) visit(source.node);
      path.pop_back();
      state[static_cast<std::size_t>(i)] = State::done;
      order_.push_back(i);
    };
    for (std::size_t i = 0; i < nodes_.size(); ++i) visit(static_cast<int>(i));
  }

  void complain_cycle(std::vector<int>::const_iterator first, std::vector<int>::const_iterator last) {
    const auto& node = nodes_[static_cast<std::size_t>(*first)];
    std::string round;
    for (; first != last; ++first) {
      round += nodes_[static_cast<std::size_t>(*first)].name + " <- ";
      unsure_[static_cast<std::size_t>(*first)] = true;
    }
    diagnostics_.error(node.place, fmt::format("these nodes form a cycle: {}{}", round, node.name));
  }

  /// Of every node but those behind a wire that could not be drawn.
  void find_domains() {
    for (const int i : order_) {
      const auto at = static_cast<std::size_t>(i);
      for (const auto& wire : nodes_[at].inputs)
        for (const auto& source : wire.sources)
          if (unsure_[static_cast<std::size_t>(source.node)]) unsure_[at] = true;
      if (!unsure_[at]) find_domain(i);
    }
  }

  int output_domain(const Graph::Port& p) const {
    return nodes_[static_cast<std::size_t>(p.node)].output_domain(p.node);
  }

  /// A node runs per item if a stream is wired to one of its item ports.
  void find_domain(int index) {
    auto& node = nodes_[static_cast<std::size_t>(index)];
    const PortSpec* first = nullptr;
    for (std::size_t p = 0; p < node.inputs.size(); ++p) {
      const auto& spec = node.type->inputs[p];
      const auto& wire = node.inputs[p];
      for (const auto& source : wire.sources) {
        const int domain = output_domain(source);
        if (spec.kind == PortSpec::Kind::collected) {
          check_collecting(node, spec, wire, source, domain);
        } else if (domain >= 0 && node.domain < 0) {
          node.domain = domain;
          first = &spec;
        } else if (domain >= 0 && domain != node.domain) {
          diagnostics_.error(
              node.place,
              fmt::format("node \"{}\": inputs \"{}\" and \"{}\" come from different streams, \"{}\" and "
                          "\"{}\": only streams of one source can be joined by key",
                          node.name, first->name, spec.name, domain_name(node.domain), domain_name(domain)));
        }
      }
    }
    if (node.type->makes_stream && node.domain >= 0)
      diagnostics_.error(node.place, fmt::format("node \"{}\" makes a stream itself and cannot run for each item of "
                                                 "\"{}\": give it single values",
                                                 node.name, domain_name(node.domain)));
  }

  void check_collecting(const Graph::Node& node, const PortSpec& spec, const Graph::Wire& wire,
                        const Graph::Port& source, int domain) {
    if (wire.gathers_stream && domain < 0)
      diagnostics_.error(node.place, fmt::format("node \"{}\": input \"{}\" collects a stream, but \"{}\" is a single "
                                                 "value: write {{\"NAME\": \"{}\"}} to collect single values",
                                                 node.name, spec.name, port_name(source), port_name(source)));
    if (!wire.gathers_stream && domain >= 0)
      diagnostics_.error(node.place, fmt::format("node \"{}\": input \"{}\" collects single values here, but \"{}\" is "
                                                 "a stream: wire it alone, or collect it first",
                                                 node.name, spec.name, port_name(source)));
  }

  std::string domain_name(int domain) const { return nodes_[static_cast<std::size_t>(domain)].name; }

  /// Keeps what outputs and sinks need, renumbered in topological order.
  Graph assemble(const std::vector<Graph::Output>& outputs) {
    std::vector<bool> needed(nodes_.size(), false);
    for (const auto& output : outputs) needed[static_cast<std::size_t>(output.source.node)] = true;
    for (auto it = order_.rbegin(); it != order_.rend(); ++it) {
      const auto& node = nodes_[static_cast<std::size_t>(*it)];
      if (node.type->sink) needed[static_cast<std::size_t>(*it)] = true;
      if (needed[static_cast<std::size_t>(*it)])
        for (const auto& wire : node.inputs)
          for (const auto& source : wire.sources) needed[static_cast<std::size_t>(source.node)] = true;
    }
    std::vector<int> number(nodes_.size(), -1);
    Graph graph;
    graph.seed = draft_.seed;
    for (const int i : order_) {
      if (!needed[static_cast<std::size_t>(i)]) continue;
      number[static_cast<std::size_t>(i)] = static_cast<int>(graph.nodes.size());
      Graph::Node node = nodes_[static_cast<std::size_t>(i)];
      if (node.domain >= 0) node.domain = number[static_cast<std::size_t>(node.domain)];
      for (auto& wire : node.inputs)
        for (auto& source : wire.sources) source.node = number[static_cast<std::size_t>(source.node)];
      graph.nodes.push_back(std::move(node));
    }
    for (const auto& output : outputs)
      graph.outputs.push_back(
          {output.name, {number[static_cast<std::size_t>(output.source.node)], output.source.port}});
    for (auto& type : draft_.input_types) graph.input_types.push_back(std::move(type));
    if (const auto* d = draft_.root->json.find("description"); d && d->value.is(Kind::text))
      graph.description = d->value.scalar.get<std::string>();
    graph.resolved = resolved(graph);
    return graph;
  }

  static Json resolved(const Graph& graph) {
    const auto reference = [&](const Graph::Port& p) {
      const auto& node = graph.nodes[static_cast<std::size_t>(p.node)];
      return node.name + "." + node.type->outputs[static_cast<std::size_t>(p.port)].name;
    };
    Json out = {{"description", graph.description}, {"seed", graph.seed}, {"nodes", Json::object()}};
    for (const auto& node : graph.nodes) {
      Json json = {{"type", node.type->name}};
      for (std::size_t p = 0; p < node.inputs.size(); ++p) {
        const auto& wire = node.inputs[p];
        const auto& spec = node.type->inputs[p];
        if (spec.kind == PortSpec::Kind::collected && !wire.gathers_stream) {
          Json& in = json["in"][spec.name] = Json::object();
          for (std::size_t i = 0; i < wire.sources.size(); ++i) in[wire.names[i]] = reference(wire.sources[i]);
        } else if (!wire.sources.empty()) {
          json["in"][spec.name] = reference(wire.sources.front());
        }
      }
      json["params"] = node.functor->parameters();
      out["nodes"][node.name] = std::move(json);
    }
    out["outputs"] = Json::object();
    for (const auto& output : graph.outputs) out["outputs"][output.name] = reference(output.source);
    return out;
  }

  Draft& draft_;
  const Registry& registry_;
  Diagnostics& diagnostics_;
  std::vector<Graph::Node> nodes_;
  std::vector<int> order_;
  std::vector<bool> unsure_;  ///< nodes whose domain cannot be known, as a wire before them is wrong
};

}  // namespace

std::optional<Graph> connect(Draft& draft, const Registry& registry, Diagnostics& diagnostics) {
  return Connector(draft, registry, diagnostics).run();
}

}  // namespace talkgraph::detail
