// 7. A graph run from a C++ program, which registers its own nodes: program 06_graph.json FOLDER
#include <iostream>

#include "06_nodes.h"
#include "nodes/all_nodes.h"
#include "nodes/types/report.h"
#include "runtime/executor.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "usage: program GRAPH.json FOLDER\n", 2;
  talkgraph::Registry registry = talkgraph::all_nodes();
  mine::add_nodes(registry);
  talkgraph::Diagnostics mistakes;
  const auto graph = talkgraph::load_graph(argv[1], registry, mistakes);
  if (!graph) return std::cerr << mistakes.str() << '\n', 2;
  talkgraph::RunOptions options;
  options.folder = argv[2];
  const talkgraph::RunResult result = talkgraph::run(*graph, options);
  std::cout << "correlation " << result.output("scores").value.get<talkgraph::Table>().cells[0][0] << '\n';
}
