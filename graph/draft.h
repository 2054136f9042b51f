#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "graph/graph.h"

namespace talkgraph::detail {

/// A graph file opened up: its text, its parameters' values, its nodes. Graphs
/// used as nodes are scopes of their own below it.
struct Scope {
  struct Entry {
    int node = -1;                 ///< index into Draft::nodes, or
    std::unique_ptr<Scope> graph;  ///< a graph used as a node
    LocatedJson json;              ///< its text, parameters substituted
  };

  std::string prefix;  ///< "speech/" in front of the names of its nodes
  LocatedJson json;
  const Scope* parent = nullptr;
  const LocatedJson* in = nullptr;  ///< wiring of its inputs, as its parent's text gives it
  std::map<std::string, LocatedJson> parameters;
  std::map<std::string, Entry> entries;  ///< by name within this graph
};

/// Nodes made, wires not yet drawn.
struct Draft {
  struct Made {
    std::string name;
    const NodeType* type = nullptr;
    std::shared_ptr<const Functor> functor;
    const Scope* scope = nullptr;
    const LocatedJson* json = nullptr;
    Place place;
  };

  std::unique_ptr<Scope> root;
  std::vector<Made> nodes;
  std::vector<std::unique_ptr<NodeType>> input_types;  ///< of a fragment looked at by itself
  std::uint64_t seed = 1;
};

/// Draws the wires, checks types and domains, sorts, prunes.
std::optional<Graph> connect(Draft& draft, const Registry& registry, Diagnostics& diagnostics);

/// "type" or "Stream<type>" of a declared graph input.
struct DeclaredInput {
  std::string type;
  bool stream = false;
  bool optional = false;
};
std::optional<DeclaredInput> declared_input(const LocatedJson& json, const Registry& registry,
                                            Diagnostics& diagnostics);

/// The text of the graph whose file is named; nothing if that cannot be read.
std::shared_ptr<const SourceText> read_graph(const LocatedJson& file, Diagnostics& diagnostics);

/// A graph or an experiment; where it extends another file, that one with this one laid over it. `open` names the files
/// that lead here, so that none extends itself.
std::optional<LocatedJson> parse_extended(const std::shared_ptr<const SourceText>& text, std::vector<std::string>& open,
                                          Diagnostics& diagnostics);

/// What a file of that path holds, with what it extends.
std::optional<LocatedJson> parse_file(const std::filesystem::path& file, Diagnostics& diagnostics);

/// "path=value", as given to --set.
std::optional<Change> parse_set(const std::string& set, Diagnostics& diagnostics);

/// Complain of members that are not allowed, or of what is no object.
void check_keys(const LocatedJson& json, const std::vector<std::string>& allowed, const std::string& subject,
                Diagnostics& diagnostics);
bool expect_object(const LocatedJson& json, const std::string& subject, Diagnostics& diagnostics);

/// The members of an object part of a graph ("nodes"), or nothing if absent.
const std::vector<LocatedJson::Member>& members_of(const LocatedJson& json, std::string_view key);

}  // namespace talkgraph::detail
