#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "graph/draft.h"

namespace talkgraph {
namespace detail {
namespace {

using Kind = LocatedJson::Kind;

const std::vector<std::string> graph_keys = {"$schema", "description", "parameters", "inputs",
                                             "nodes",   "outputs",     "seed"};
const std::vector<std::string> node_keys = {"type", "graph", "in", "params", "description"};

std::vector<std::string> keys_of(const LocatedJson& json) {
  std::vector<std::string> keys;
  for (const auto& m : json.members) keys.push_back(m.key);
  return keys;
}

std::vector<std::string> names_of(const std::map<std::string, LocatedJson>& parameters) {
  std::vector<std::string> names;
  for (const auto& [name, value] : parameters) names.push_back(name);
  return names;
}

/// Puts parameter values in place of ${name} throughout a value. A text that is
/// exactly ${name} becomes the parameter's value, type and place and all.
class Substitution {
 public:
  Substitution(const std::map<std::string, LocatedJson>& parameters, Diagnostics& diagnostics)
      : parameters_(parameters), diagnostics_(diagnostics) {}

  LocatedJson operator()(const LocatedJson& json) const {
    if (json.is(Kind::text)) return text(json);
    LocatedJson out = json;
    for (auto& item : out.items) item = (*this)(item);
    for (auto& m : out.members) m.value = (*this)(m.value);
    return out;
  }

 private:
  LocatedJson text(const LocatedJson& json) const {
    const auto given = json.scalar.get<std::string>();
    LocatedJson out = json;
    std::string result;
    for (std::size_t at = 0; at < given.size();) {
      if (given.compare(at, 3, "$${") == 0) {
        result += "${";
        at += 3;
        continue;
      }
      const auto close = given.compare(at, 2, "${") == 0 ? given.find('}', at) : std::string::npos;
      if (close == std::string::npos) {
        result += given[at++];
        continue;
      }
      const LocatedJson* value = find(given.substr(at + 2, close - at - 2), json.place);
      if (!value) return json;
      if (at == 0 && close + 1 == given.size()) return *value;
      if (value->is(Kind::object) || value->is(Kind::array) || value->is(Kind::null)) {
        diagnostics_.error(json.place, fmt::format("{} cannot stand inside a text", value->kind_name()));
        return json;
      }
      // A path that begins with a parameter is relative to where that was written.
      if (at == 0) out.place = value->place;
      result += value->is(Kind::text) ? value->scalar.get<std::string>() : value->scalar.dump();
      at = close + 1;
    }
    out.scalar = result;
    return out;
  }

  const LocatedJson* find(const std::string& name, const Place& place) const {
    const auto it = parameters_.find(name);
    if (it != parameters_.end()) return &it->second;
    diagnostics_.error(place,
                       fmt::format("unknown parameter ${{{}}}{}", name, did_you_mean(name, names_of(parameters_))));
    return nullptr;
  }

  const std::map<std::string, LocatedJson>& parameters_;
  Diagnostics& diagnostics_;
};

std::shared_ptr<const SourceText> read_text_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) return nullptr;
  return std::make_shared<SourceText>(
      SourceText{file.string(), {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}});
}

std::string nearby_graphs(const std::filesystem::path& file) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::directory_iterator(file.parent_path().empty() ? "." : file.parent_path(), ignored))
    if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
  return did_you_mean(file.filename().string(), names);
}

/// Lays a patch over a value (JSON merge patch, RFC 7396): members are merged, null takes one away, all else replaces.
/// What is taken away must be there.
void merge(LocatedJson& base, const LocatedJson& patch, const std::string& at, Diagnostics& diagnostics) {
  if (!patch.is(Kind::object) || !base.is(Kind::object)) {
    base = patch;
    return;
  }
  for (const auto& m : patch.members) {
    auto* there = base.find(m.key);
    const std::string name = at.empty() ? m.key : at + "." + m.key;
    if (there && !m.value.is(Kind::null)) {
      merge(there->value, m.value, name, diagnostics);
    } else if (there) {
      std::erase_if(base.members, [&](const auto& old) { return old.key == m.key; });
    } else if (m.value.is(Kind::null)) {
      diagnostics.error(
          m.key_place,
          fmt::format("null takes \"{}\" away, but what this is laid over has none{}{}", name,
                      did_you_mean(m.key, keys_of(base)),
                      at.ends_with(".params") ? "; \"${name}\" of a parameter whose default is null gives null" : ""));
    } else {
      base.members.push_back(m);
    }
  }
}

/// A change whose path is taken apart.
struct Setting {
  std::vector<std::string> path;
  LocatedJson value;
};

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= path.size();) {
    const auto dot = std::min(path.find('.', at), path.size());
    parts.push_back(path.substr(at, dot - at));
    at = dot + 1;
  }
  return parts;
}

/// Whether a path names what null takes away: a node, a wire, an output.
bool can_be_taken_away(const std::vector<std::string>& path) {
  const bool named = path.size() == 2 && (path[0] == "nodes" || path[0] == "outputs");
  return named || (path.size() == 4 && path[0] == "nodes" && path[2] == "in");
}

/// Changes a graph's text before anything is read from it. `where` names the graph in complaints: ` in "hear"`, or
/// nothing.
void apply(const Setting& setting, LocatedJson& graph, const std::string& where, Diagnostics& diagnostics) {
  const auto& [path, value] = setting;
  const bool takes_away = value.is(Kind::null) && can_be_taken_away(path);
  LocatedJson *at = &graph, *parent = nullptr;
  bool there = true;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!at->is(Kind::object))
      return diagnostics.error(value.place, fmt::format("nothing can be set below \"{}\"", path[i - 1]));
    auto* member = at->find(path[i]);
    const bool may_add = i + 1 == path.size() || path[i] == "params" || path[i] == "in";
    if (!member && !may_add)
      return diagnostics.error(value.place, fmt::format("there is no \"{}\"{} to set{}", path[i], where,
                                                        did_you_mean(path[i], keys_of(*at))));
    there = member != nullptr;
    if (!there && takes_away && path.size() == 2)
      return diagnostics.error(value.place, fmt::format("there is no \"{}\"{} to take away{}", path[i], where,
                                                        did_you_mean(path[i], keys_of(*at))));
    if (!there) {
      LocatedJson empty;
      empty.kind = Kind::object;
      empty.place = value.place;
      at->members.push_back({path[i], value.place, empty});
      member = &at->members.back();
    }
    parent = at;
    at = &member->value;
  }
  // Of an input that has no wire the null stays, so that the node is asked whether it has such an input.
  if (takes_away && there)
    std::erase_if(parent->members, [&name = path.back()](const auto& m) { return m.key == name; });
  else
    *at = value;
}

/// Opens graphs: substitutes parameters, makes functors, descends into graphs used as nodes.
class Loader {
 public:
  Loader(const Registry& registry, Diagnostics& diagnostics) : registry_(registry), diagnostics_(diagnostics) {}

  Draft draft;

  /// Changes the root graph, or keeps the change until the graph is opened that holds its node.
  void change(LocatedJson& root, const Change& change) {
    auto path = parts_of(change.path);
    // A parameter of the graph may be named alone.
    if (path.size() == 1 && path[0] != "seed" && path[0] != "description") {
      const auto* parameters = root.find("parameters");
      if (!parameters || !parameters->value.find(path[0]))
        return diagnostics_.error(
            change.value.place,
            fmt::format("the graph has no parameter \"{}\" to set{}", path[0],
                        did_you_mean(path[0], parameters ? keys_of(parameters->value) : std::vector<std::string>{})));
      path = {"parameters", path[0], "default"};
    }
    set_in(root, "", {std::move(path), change.value});
  }

  void open_root(LocatedJson json, const LocatedJson* given = nullptr) {
    draft.root = std::make_unique<Scope>();
    draft.root->json = std::move(json);
    open(*draft.root, given, "graph");
    if (const auto* seed = draft.root->json.find("seed")) {
      std::int64_t value = 1;
      const LocatedJson given = Substitution(draft.root->parameters, diagnostics_)(seed->value);
      if (read_integer(given, value, Range{0, 9e15, false}, 0, 9e15, "seed", diagnostics_))
        draft.seed = static_cast<std::uint64_t>(value);
    }
    add_graph_inputs();
    if (!diagnostics_.ok()) return;
    for (const auto& [node, settings] : inner_settings_)
      diagnostics_.error(settings.front().value.place, fmt::format("\"{}\" is no graph any more to set in", node));
  }

 private:
  /// "nodes.hear/speech/mel.params.filters" means the node "mel" of the graph that the node "speech" is, in that which
  /// the node "hear" is.
  void set_in(LocatedJson& graph, const std::string& prefix, Setting setting) {
    const std::string where = prefix.empty() ? "" : fmt::format(" in \"{}\"", prefix.substr(0, prefix.size() - 1));
    const auto* nodes = graph.find("nodes");
    const auto slash = setting.path.size() > 1 ? setting.path[1].find('/') : std::string::npos;
    if (setting.path[0] != "nodes" || slash == std::string::npos || !nodes || is_flat(nodes->value))
      return apply(setting, graph, where, diagnostics_);
    auto& name = setting.path[1];
    const std::string outer = name.substr(0, slash);
    const auto* node = nodes->value.find(outer);
    if (!node)
      return diagnostics_.error(setting.value.place, fmt::format("there is no \"{}\"{} to set{}", outer, where,
                                                                 did_you_mean(outer, keys_of(nodes->value))));
    if (!is_graph(nodes->value, *node))
      return diagnostics_.error(setting.value.place, fmt::format("\"{}\" is a node, not a graph with a node \"{}\"",
                                                                 prefix + outer, name.substr(slash + 1)));
    name.erase(0, slash + 1);
    inner_settings_[prefix + outer].push_back(std::move(setting));
  }

  /// Whether graphs used as nodes are spliced in already, as in a run folder or a model.
  static bool is_flat(const LocatedJson& nodes) {
    return std::any_of(nodes.members.begin(), nodes.members.end(),
                       [](const auto& m) { return m.key.find('/') != std::string::npos; });
  }

  /// Whether a node is a graph, itself or as what it is like.
  static bool is_graph(const LocatedJson& nodes, const LocatedJson::Member& node) {
    const auto* at = &node;
    for (std::size_t steps = 0; at && steps <= nodes.members.size(); ++steps) {
      if (at->value.find("graph")) return true;
      const auto* like = at->value.find("like");
      at = like && like->value.is(Kind::text) ? nodes.find(like->value.scalar.get<std::string>()) : nullptr;
    }
    return false;
  }

  void open(Scope& scope, const LocatedJson* given, const std::string& subject) {
    if (!expect_object(scope.json, subject, diagnostics_)) return;
    check_keys(scope.json, graph_keys, subject, diagnostics_);
    read_parameters(scope, given, subject);
    const Substitution substitute(scope.parameters, diagnostics_);
    const auto* nodes = scope.json.find("nodes");
    if (!nodes) return diagnostics_.error(scope.json.place, subject + " has no \"nodes\"");
    if (!expect_object(nodes->value, "\"nodes\"", diagnostics_)) return;
    for (const auto& m : nodes->value.members) {
      const auto whole = whole_node(nodes->value, m, {});
      if (!whole) continue;
      auto& entry = scope.entries[m.key];
      entry.json = substitute(*whole);
      open_node(scope, m, entry);
    }
  }

  /// A node's text; where it is like another node of the graph, that one's with its own laid over it. `copied` names
  /// the nodes that are like it.
  std::optional<LocatedJson> whole_node(const LocatedJson& nodes, const LocatedJson::Member& node,
                                        std::vector<std::string> copied) {
    const auto* like = node.value.find("like");
    if (!like) return node.value;
    const std::string subject = fmt::format("node \"{}\"", node.key);
    std::string name;
    if (!read_text(like->value, name, "the name of a node", subject + ": \"like\"", diagnostics_)) return {};
    copied.push_back(node.key);
    if (std::ranges::find(copied, name) != copied.end())
      return diagnostics_.error(like->value.place, subject + " is like itself"), std::nullopt;
    const auto* other = nodes.find(name);
    if (!other)
      return diagnostics_.error(like->value.place, fmt::format("{} is like \"{}\", which is no node here{}", subject,
                                                               name, did_you_mean(name, keys_of(nodes)))),
             std::nullopt;
    auto whole = whole_node(nodes, *other, std::move(copied));
    if (!whole) return {};
    LocatedJson own = node.value;
    std::erase_if(own.members, [](const auto& m) { return m.key == "like"; });
    merge(*whole, own, node.key, diagnostics_);
    return whole;
  }

  void read_parameters(Scope& scope, const LocatedJson* given, const std::string& subject) {
    const auto* declared = scope.json.find("parameters");
    if (declared && expect_object(declared->value, "\"parameters\"", diagnostics_))
      for (const auto& m : declared->value.members) {
        if (!expect_object(m.value, fmt::format("parameter \"{}\"", m.key), diagnostics_)) continue;
        check_keys(m.value, {"default", "doc"}, fmt::format("parameter \"{}\"", m.key), diagnostics_);
        const auto* own = given ? given->find(m.key) : nullptr;
        if (own)
          scope.parameters[m.key] = own->value;
        else if (const auto* initial = m.value.find("default"))
          scope.parameters[m.key] = initial->value;
        else
          diagnostics_.error(given ? given->place : m.key_place,
                             fmt::format("{}: parameter \"{}\" must be given", subject, m.key));
      }
    if (!given) return;
    for (const auto& m : given->members)
      if (!declared || !declared->value.find(m.key))
        diagnostics_.error(m.key_place, fmt::format("{}: unknown parameter \"{}\"{}", subject, m.key,
                                                    did_you_mean(m.key, names_of(scope.parameters))));
  }

  void open_node(Scope& scope, const LocatedJson::Member& member, Scope::Entry& entry) {
    const std::string subject = fmt::format("node \"{}\"", scope.prefix + member.key);
    if (member.key.empty() || member.key.find_first_of(". ") != std::string::npos || member.key == "inputs")
      diagnostics_.error(member.key_place, fmt::format("\"{}\" cannot be the name of a node", member.key));
    if (!expect_object(entry.json, subject, diagnostics_)) return;
    check_keys(entry.json, node_keys, subject, diagnostics_);
    for (const char* part : {"in", "params"})
      if (const auto* m = entry.json.find(part))
        expect_object(m->value, fmt::format("{}: \"{}\"", subject, part), diagnostics_);
    const auto* type = entry.json.find("type");
    const auto* graph = entry.json.find("graph");
    if (!type == !graph)
      return diagnostics_.error(member.key_place, subject + " must have either a \"type\" or a \"graph\"");
    if (type)
      make_node(scope, member, entry, type->value, subject);
    else
      open_graph_node(scope, member, entry, graph->value, subject);
  }

  void make_node(Scope& scope, const LocatedJson::Member& member, Scope::Entry& entry, const LocatedJson& type,
                 const std::string& subject) {
    std::string name;
    if (!read_text(type, name, "a node type", subject + ": \"type\"", diagnostics_)) return;
    const NodeType* known = registry_.find(name);
    if (!known)
      return diagnostics_.error(type.place, fmt::format("{}: unknown node type \"{}\"{}", subject, name,
                                                        did_you_mean(name, registry_.names())));
    auto* params = entry.json.find("params");
    if (params) embed_graphs(*known, params->value);
    if (std::any_of(draft.nodes.begin(), draft.nodes.end(),
                    [&](const auto& made) { return made.name == scope.prefix + member.key; }))
      diagnostics_.error(member.key_place, subject + " stands twice: here and in a graph used as a node");
    entry.node = static_cast<int>(draft.nodes.size());
    draft.nodes.push_back({scope.prefix + member.key, known,
                           known->make(params ? &params->value : nullptr, member.key_place, subject, diagnostics_),
                           &scope, &entry.json, member.key_place});
  }

  /// A parameter that is a graph: a file name, or {"graph": file, "params": {...}}; the node gets it resolved.
  void embed_graphs(const NodeType& type, LocatedJson& params) {
    for (const auto& spec : type.parameters) {
      auto* given = spec.type == "graph" ? params.find(spec.name) : nullptr;
      if (!given) continue;
      const auto* file = given->value.is(Kind::object) ? given->value.find("graph") : nullptr;
      const auto* inner = given->value.is(Kind::object) ? given->value.find("params") : nullptr;
      const LocatedJson& named = file ? file->value : given->value;
      // A graph that is resolved already, as a saved model holds it.
      if (named.is(Kind::text) &&
          (named.scalar.get<std::string>().empty() || named.scalar.get<std::string>()[0] == '{'))
        continue;
      const auto text = read_graph(named, diagnostics_);
      if (!text) continue;
      Loader loader(registry_, diagnostics_);
      loader.open_stack_ = open_stack_;
      auto json = parse_extended(text, open_stack_, diagnostics_);
      if (!json) continue;
      loader.open_root(*std::move(json), inner ? &inner->value : nullptr);
      if (const auto graph = connect(loader.draft, registry_, diagnostics_)) {
        LocatedJson resolved;
        resolved.kind = Kind::text;
        resolved.scalar = graph->resolved.dump();
        resolved.place = named.place;
        given->value = std::move(resolved);
      } else {
        given->value = located("{}", named.place);
      }
    }
  }

  void open_graph_node(Scope& scope, const LocatedJson::Member& member, Scope::Entry& entry, const LocatedJson& file,
                       const std::string& subject) {
    const auto text = read_graph(file, diagnostics_);
    if (!text) return;
    if (std::find(open_stack_.begin(), open_stack_.end(), text->name) != open_stack_.end())
      return diagnostics_.error(file.place, fmt::format("{}: the graph {} contains itself", subject, text->name));
    auto json = parse_extended(text, open_stack_, diagnostics_);
    if (!json) return;
    entry.graph = std::make_unique<Scope>();
    Scope& inner = *entry.graph;
    inner.prefix = scope.prefix + member.key + "/";
    inner.parent = &scope;
    inner.json = *std::move(json);
    if (auto settings = inner_settings_.extract(scope.prefix + member.key))
      for (auto& setting : settings.mapped()) set_in(inner.json, inner.prefix, std::move(setting));
    const auto* in = entry.json.find("in");
    inner.in = in ? &in->value : nullptr;
    const auto* params = entry.json.find("params");
    LocatedJson none;
    none.kind = Kind::object;
    none.place = member.key_place;
    open_stack_.push_back(text->name);
    open(inner, params ? &params->value : &none, subject);
    open_stack_.pop_back();
    const auto& declared = members_of(inner.json, "inputs");
    for (const auto& d : declared) {
      const auto type = declared_input(d.value, registry_, diagnostics_);
      const auto* given = inner.in ? inner.in->find(d.key) : nullptr;
      if (type && !type->optional && (!given || given->value.is(Kind::null)))
        diagnostics_.error(member.key_place,
                           fmt::format("{}: input \"{}\" ({}) is not wired", subject, d.key, type->type));
    }
    if (!inner.in) return;
    std::vector<std::string> names;
    for (const auto& d : declared) names.push_back(d.key);
    for (const auto& m : inner.in->members)
      if (std::find(names.begin(), names.end(), m.key) == names.end())
        diagnostics_.error(m.key_place,
                           fmt::format("{}: unknown input \"{}\"{}", subject, m.key, did_you_mean(m.key, names)));
  }

  /// A fragment by itself: its inputs stand as sources that cannot run.
  void add_graph_inputs();

  const Registry& registry_;
  Diagnostics& diagnostics_;
  std::vector<std::string> open_stack_;
  std::map<std::string, std::vector<Setting>> inner_settings_;  ///< by the node that is the graph they change
};

/// Stands for the inputs of a graph that is looked at, not run.
class UnboundInputs final : public Functor {
 public:
  void call(std::span<const Input>, Context&, Random&, std::vector<Value>&) const override { fail(); }
  AnyStream stream(std::span<const Input>, Context&, Random&) const override { fail(); }
  Json parameters() const override { return Json::object(); }

 private:
  [[noreturn]] static void fail() {
    throw std::runtime_error("this graph has inputs: use it as a node of another graph, which wires them");
  }
};

void Loader::add_graph_inputs() {
  for (const bool streams : {false, true}) {
    auto type = std::make_unique<NodeType>();
    type->name = "inputs";
    type->makes_stream = streams;
    for (const auto& m : members_of(draft.root->json, "inputs")) {
      const auto input = declared_input(m.value, registry_, diagnostics_);
      if (!input || input->stream != streams) continue;
      PortSpec port;
      port.name = m.key;
      port.type = {*std::find_if(registry_.port_types().begin(), registry_.port_types().end(),
                                 [&](const PortType& t) { return t.name == input->type; })};
      type->outputs.push_back(port);
    }
    if (type->outputs.empty()) continue;
    draft.nodes.push_back({streams ? "inputs (streams)" : "inputs", type.get(), std::make_shared<UnboundInputs>(),
                           nullptr, nullptr, draft.root->json.place});
    draft.input_types.push_back(std::move(type));
  }
}

}  // namespace

std::shared_ptr<const SourceText> read_graph(const LocatedJson& file, Diagnostics& diagnostics) {
  FilePath path;
  if (!file.is(Kind::text)) {
    diagnostics.error(file.place, fmt::format("a graph is named by its file, got {}", file.kind_name()));
    return nullptr;
  }
  read_path(file, path, "graph", diagnostics);
  auto text = read_text_file(path.path);
  if (!text)
    diagnostics.error(file.place,
                      fmt::format("unknown graph: {} cannot be read{}", path.path, nearby_graphs(path.path)));
  return text;
}

std::optional<LocatedJson> parse_extended(const std::shared_ptr<const SourceText>& text, std::vector<std::string>& open,
                                          Diagnostics& diagnostics) {
  auto json = parse_json(text, diagnostics);
  auto* extends = json ? json->find("extends") : nullptr;
  if (!extends) return json;
  const auto base_text = read_graph(extends->value, diagnostics);
  if (!base_text) return {};
  if (std::find(open.begin(), open.end(), base_text->name) != open.end() || base_text->name == text->name)
    return diagnostics.error(extends->value.place, fmt::format("{} extends itself", base_text->name)), std::nullopt;
  open.push_back(text->name);
  auto base = parse_extended(base_text, open, diagnostics);
  open.pop_back();
  if (!base) return {};
  std::erase_if(json->members, [](const auto& m) { return m.key == "extends"; });
  merge(*base, *json, "", diagnostics);
  return base;
}

std::optional<LocatedJson> parse_file(const std::filesystem::path& file, Diagnostics& diagnostics) {
  const auto text = read_text_file(file);
  if (!text)
    return diagnostics.error({}, fmt::format("{}: cannot be read{}", file.string(), nearby_graphs(file))), std::nullopt;
  std::vector<std::string> open;
  return parse_extended(text, open, diagnostics);
}

std::optional<Change> parse_set(const std::string& set, Diagnostics& diagnostics) {
  const auto equals = set.find('=');
  const auto source = std::make_shared<SourceText>(SourceText{"--set", set});
  const Place place{source, 1, 1, static_cast<int>(set.size())};
  if (equals == std::string::npos || equals == 0)
    return diagnostics.error(place, "--set takes path=value, such as nodes.mfcc.params.filters=20"), std::nullopt;
  const std::string text = set.substr(equals + 1);
  Diagnostics not_json;
  const auto value = parse_json(std::make_shared<SourceText>(SourceText{"--set", text}), not_json);
  return Change{set.substr(0, equals), located(not_json.ok() ? value->plain() : Json(text), place)};
}

void check_keys(const LocatedJson& json, const std::vector<std::string>& allowed, const std::string& subject,
                Diagnostics& diagnostics) {
  for (const auto& m : json.members)
    if (std::find(allowed.begin(), allowed.end(), m.key) == allowed.end())
      diagnostics.error(m.key_place,
                        fmt::format("{}: unknown key \"{}\"{}", subject, m.key, did_you_mean(m.key, allowed)));
}

bool expect_object(const LocatedJson& json, const std::string& subject, Diagnostics& diagnostics) {
  if (json.is(Kind::object)) return true;
  diagnostics.error(json.place, fmt::format("{} must be an object, got {}", subject, json.kind_name()));
  return false;
}

const std::vector<LocatedJson::Member>& members_of(const LocatedJson& json, std::string_view key) {
  static const std::vector<LocatedJson::Member> none;
  const auto* m = json.find(key);
  return m ? m->value.members : none;
}

std::optional<DeclaredInput> declared_input(const LocatedJson& json, const Registry& registry,
                                            Diagnostics& diagnostics) {
  DeclaredInput input;
  const LocatedJson* type = &json;
  if (json.is(Kind::object)) {
    check_keys(json, {"type", "optional", "doc"}, "graph input", diagnostics);
    if (const auto* m = json.find("optional"))
      read_parameter(m->value, input.optional, {}, "\"optional\"", diagnostics);
    const auto* m = json.find("type");
    if (!m) return diagnostics.error(json.place, "a graph input needs a \"type\""), std::nullopt;
    type = &m->value;
  }
  if (!read_text(*type, input.type, "a type name", "graph input", diagnostics)) return {};
  if (input.type.starts_with("Stream<") && input.type.ends_with(">")) {
    input.stream = true;
    input.type = input.type.substr(7, input.type.size() - 8);
  }
  std::vector<std::string> known;
  for (const auto& t : registry.port_types()) known.emplace_back(t.name);
  if (std::find(known.begin(), known.end(), input.type) != known.end()) return input;
  diagnostics.error(type->place, fmt::format("unknown type \"{}\"{}", input.type, did_you_mean(input.type, known)));
  return {};
}

}  // namespace detail

namespace {

std::optional<Graph> load_graph_json(const std::string& name, LocatedJson json, const Registry& registry,
                                     Diagnostics& diagnostics, const LoadOptions& options) {
  detail::Loader loader(registry, diagnostics);
  for (const auto& set : options.sets)
    if (const auto change = detail::parse_set(set, diagnostics)) loader.change(json, *change);
  for (const auto& change : options.changes) loader.change(json, change);
  loader.open_root(std::move(json));
  auto graph = detail::connect(loader.draft, registry, diagnostics);
  if (graph) graph->name = name;
  return graph;
}

}  // namespace

std::optional<Graph> load_graph_text(const std::string& name, const std::string& text, const Registry& registry,
                                     Diagnostics& diagnostics, const LoadOptions& options) {
  std::vector<std::string> open;
  auto json = detail::parse_extended(std::make_shared<SourceText>(SourceText{name, text}), open, diagnostics);
  if (!json) return {};
  return load_graph_json(name, *std::move(json), registry, diagnostics, options);
}

std::optional<Graph> load_graph(const std::filesystem::path& file, const Registry& registry, Diagnostics& diagnostics,
                                const LoadOptions& options) {
  auto json = detail::parse_file(file, diagnostics);
  if (!json) return {};
  return load_graph_json(file.string(), *std::move(json), registry, diagnostics, options);
}

}  // namespace talkgraph
