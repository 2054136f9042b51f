#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/registry.h"

namespace talkgraph {

/// A checked graph, flat and ready to run: graphs used as nodes are spliced in
/// ("speech/mfcc"), parameters are substituted, every edge is typed.
struct Graph {
  /// An output port of a node.
  struct Port {
    int node = 0;
    int port = 0;
    bool operator==(const Port&) const = default;
  };

  /// What is wired to an input port.
  struct Wire {
    /// One source for most ports; several, with their names, where an object of
    /// single values is wired to a collecting port; none for an absent optional.
    std::vector<Port> sources;
    std::vector<std::string> names;
    /// A collecting port that gathers one stream, not named single values.
    bool gathers_stream = false;
  };

  struct Node {
    std::string name;
    const NodeType* type = nullptr;
    std::shared_ptr<const Functor> functor;
    std::vector<Wire> inputs;  ///< one an input port
    /// The node whose keys this one runs for, or -1 if it runs once. A source
    /// runs once; what it makes lives in its own domain.
    int domain = -1;
    Place place;

    int output_domain(int self) const { return type->makes_stream ? self : domain; }
  };

  struct Output {
    std::string name;
    Port source;
  };

  std::string name;  ///< file it came from
  std::string description;
  std::vector<Node> nodes;  ///< in topological order
  std::vector<Output> outputs;
  std::uint64_t seed = 1;
  Json resolved;  ///< the whole graph, self-contained, as it can be run again
  std::vector<std::shared_ptr<const NodeType>> input_types;  ///< of a fragment's own inputs, which cannot run
};

/// A value put into a graph's text before anything is read from it; null takes a node, a wire or an output away.
struct Change {
  std::string path;   ///< "nodes.mel.params.filters", or a parameter of the graph by its name alone
  LocatedJson value;  ///< its place is where a file name in it counts from, and what complaints name
};

/// How a graph is loaded.
struct LoadOptions {
  std::vector<std::string> sets = {};  ///< "path=value", as given to --set
  std::vector<Change> changes = {};    ///< after these
};

/// Reads, resolves and checks a graph file. All that is wrong goes to
/// `diagnostics`; nothing is returned then.
std::optional<Graph> load_graph(const std::filesystem::path& file, const Registry& registry, Diagnostics& diagnostics,
                                const LoadOptions& options = {});

/// The same from a text in memory; relative files are taken from the folder of
/// `name`.
std::optional<Graph> load_graph_text(const std::string& name, const std::string& text, const Registry& registry,
                                     Diagnostics& diagnostics, const LoadOptions& options = {});

}  // namespace talkgraph
