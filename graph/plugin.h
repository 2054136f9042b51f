#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "graph/registry.h"

#ifndef TALKGRAPH_PLUGIN_HEADERS
#error "TALKGRAPH_PLUGIN_HEADERS is not defined: link talkgraph::plugin, which brings it"
#endif

#define TALKGRAPH_TEXT_OF(x) #x
#define TALKGRAPH_TEXT(x) TALKGRAPH_TEXT_OF(x)
#define TALKGRAPH_EIGEN \
  TALKGRAPH_TEXT(EIGEN_WORLD_VERSION) "." TALKGRAPH_TEXT(EIGEN_MAJOR_VERSION) "." TALKGRAPH_TEXT(EIGEN_MINOR_VERSION)
#define TALKGRAPH_ALIGNMENT TALKGRAPH_TEXT(EIGEN_MAX_ALIGN_BYTES)
#define TALKGRAPH_STRINGS TALKGRAPH_TEXT(_GLIBCXX_USE_CXX11_ABI)

/// What a plugin and a program must have in common, as values pass between them as they lie in memory: talkgraph's
/// headers, Eigen and how it aligns matrices, the layout of std::string.
#define TALKGRAPH_PLUGIN_VERSION                                                                      \
  "talkgraph " TALKGRAPH_PLUGIN_HEADERS ", Eigen " TALKGRAPH_EIGEN " aligned to " TALKGRAPH_ALIGNMENT \
  ", C++ strings " TALKGRAPH_STRINGS

namespace talkgraph {

/// What a shared library with nodes tells of itself.
struct Plugin {
  const char* version;     ///< TALKGRAPH_PLUGIN_VERSION when it was compiled
  void (*add)(Registry&);  ///< registers its nodes
};

/// Adds the nodes of a shared library, which stays loaded until the program ends. The program must be linked such that
/// the library finds talkgraph in it (docs/architecture.md). Throws std::invalid_argument, which names the file, if it
/// is missing, no such library, made for another version, or if its nodes cannot be registered; some of them may be
/// registered then.
void load_plugin(const std::filesystem::path& file, Registry& registry);

}  // namespace talkgraph

/// Makes a shared library a plugin: stands once in it, and names its function `void add_nodes(talkgraph::Registry&)`.
#define TALKGRAPH_PLUGIN(add_nodes) \
  extern "C" talkgraph::Plugin talkgraph_plugin() { return {TALKGRAPH_PLUGIN_VERSION, add_nodes}; }
