#include "experiment/meanings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "nodes/plot/svg.h"
#include "nodes/types/report.h"

namespace talkgraph {
namespace {

/// What is explained, with its text.
using Terms = std::map<std::string, std::string>;

/// Of a description: parts between semicolons, of which those with a colon explain what stands before it.
void read_terms(const std::string& doc, Terms& terms) {
  for (std::size_t from = 0; from < doc.size();) {
    const auto end = std::min(doc.find("; ", from), doc.size());
    const std::string part = doc.substr(from, end - from);
    if (const auto colon = part.find(": "); colon != std::string::npos)
      terms.emplace(part.substr(0, colon), part.substr(colon + 2));
    from = end + 2;
  }
}

Terms terms_of(const std::vector<Graph>& graphs) {
  Terms terms;
  std::set<const NodeType*> seen;
  for (const auto& graph : graphs)
    for (const auto& node : graph.nodes)
      if (seen.insert(node.type).second)
        for (const auto& output : node.type->outputs)
          if (output.type == port_type<Scores> || output.type == port_type<Table>) read_terms(output.doc, terms);
  return terms;
}

bool stands_for(const std::string& term, const std::string& measure) {
  const bool any = term.starts_with("x ") || term.starts_with("x_");
  return any ? measure.ends_with(term.substr(1)) : measure == term;
}

}  // namespace

std::vector<Meaning> meanings_of(const std::vector<std::string>& measures, const std::vector<Graph>& graphs) {
  const Terms terms = terms_of(graphs);
  std::vector<Meaning> out;
  for (const auto& measure : measures) {
    const auto term =
        std::find_if(terms.begin(), terms.end(), [&](const auto& t) { return stands_for(t.first, measure); });
    if (term != terms.end()) out.push_back({measure, term->second});
  }
  return out;
}

std::string html_meanings(const std::vector<Meaning>& meanings) {
  if (meanings.empty()) return "";
  std::string out = "<details><summary>What the measures are</summary>\n<dl>\n";
  for (const auto& [measure, text] : meanings)
    out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_markup(measure), escape_markup(text));
  return out + "</dl>\n<p>More on them by these names: docs/measures.md.</p>\n</details>\n";
}

}  // namespace talkgraph
