#include "cli/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "cli/example.h"

namespace talkgraph::cli {
namespace {

/// Whether a text holds a word, in capitals or not.
bool speaks_of(const std::string& text, const std::string& word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(),
                     [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); }) != text.end();
}

std::string family_of(const std::string& type) { return type.substr(0, type.find('.')); }

std::string input_type(const PortSpec& port) {
  const std::string type(port.type.name);
  if (port.kind == PortSpec::Kind::collected) return "all of a stream of " + type;
  return port.kind == PortSpec::Kind::optional ? type + ", optional" : type;
}

std::string output_type(const PortSpec& port, const NodeType& node) {
  return fmt::format("{}{}{}", node.makes_stream ? "stream of " : "", port.type.name,
                     port.may_drop ? ", may be absent" : "");
}

std::string limits(const Range& range) {
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  if (low && high) return fmt::format("{} to {}", range.low, range.high);
  if (low) return fmt::format("{} {}", range.low_open ? "above" : "at least", range.low);
  return high ? fmt::format("at most {}", range.high) : "";
}

std::string initial(const ParameterSpec& spec) { return spec.required ? "required" : "default " + spec.initial.dump(); }

/// What is to be known beside ports and parameters, a line each.
std::vector<std::string> notes(const NodeType& type) {
  std::vector<std::string> out;
  if (!type.source.empty()) out.push_back("source: " + type.source);
  if (type.uses_random) out.emplace_back("draws random numbers from the graph's seed");
  if (type.stored) out.emplace_back("its results are kept and found again");
  if (type.sink) out.emplace_back("runs even if nothing takes what it gives");
  return out;
}

/// Lines of a name and what it is, aligned.
struct Lines {
  std::vector<std::pair<std::string, std::string>> all;
  std::string str() const {
    std::size_t width = 12;
    for (const auto& [name, text] : all)
      if (!text.empty()) width = std::max(width, name.size());
    std::string out;
    for (const auto& [name, text] : all)
      out += text.empty() ? name + "\n" : fmt::format("{:<{}}  {}\n", name, width, text);
    return out;
  }
};

void add_parameters(const std::vector<ParameterSpec>& specs, const std::string& indent, Lines& lines) {
  for (const auto& p : specs) {
    std::string kind = p.choices.empty() ? p.type : fmt::format("{}", fmt::join(p.choices, " | "));
    for (const auto& part : {p.unit, limits(p.range)})
      if (!part.empty()) kind += ", " + part;
    lines.all.emplace_back(indent + p.name, kind + "; " + initial(p));
    lines.all.emplace_back(indent, "  " + p.doc);
    add_parameters(p.members, indent + "  ", lines);
  }
}

std::string indented(const std::string& text, const std::string& indent) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size() - 1) + 1;
    out += indent + text.substr(at, end - at);
    at = end;
  }
  return out;
}

/// How the example is run.
std::string commands(const NodeType& type, bool samples) {
  return fmt::format("{}talkgraph node {} --example > example.json && talkgraph run example.json",
                     samples ? "talkgraph samples && " : "", type.name);
}

/// Markdown: text that a table or a heading takes as it is.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '>' || c == '*' || c == '_') out += '\\';
    out += c;
  }
  return out;
}

std::string link(const std::string& type) {
  std::string anchor = type;
  std::erase(anchor, '.');
  return fmt::format("[{}]({}.md#{})", escaped(type), family_of(type), anchor);
}

void add_parameter_rows(const std::vector<ParameterSpec>& specs, const std::string& prefix, std::string& out) {
  for (const auto& p : specs) {
    std::string kind = p.type;
    if (!p.choices.empty()) kind = fmt::format("`{}`", fmt::join(p.choices, "`, `"));
    out += fmt::format("| `{}{}` | {} | {} | {} | {} | {} |\n", prefix, p.name, kind, escaped(p.unit), limits(p.range),
                       p.required ? "required" : "`" + p.initial.dump() + "`", escaped(p.doc));
    add_parameter_rows(p.members, prefix + p.name + (p.type == "object" ? "." : "[]."), out);
  }
}

std::string section(const Registry& registry, const NodeType& type) {
  std::string out = fmt::format("## {}\n\n{}\n\nVersion {}", type.name, escaped(type.summary), type.version);
  for (const auto& note : notes(type)) out += "; " + escaped(note);
  out += ".\n\n";
  const auto ports = [&](const char* heading, const std::vector<PortSpec>& all, const auto& type_text) {
    if (all.empty()) return;
    out += fmt::format("| {} | type | what it is |\n|---|---|---|\n", heading);
    for (const auto& port : all)
      out += fmt::format("| `{}` | {} | {} |\n", port.name, type_text(port), escaped(port.doc));
    out += "\n";
  };
  ports("input", type.inputs, input_type);
  ports("output", type.outputs, [&](const PortSpec& port) { return output_type(port, type); });
  if (!type.parameters.empty()) {
    out += "| parameter | type | unit | limits | default | what it is |\n|---|---|---|---|---|---|\n";
    add_parameter_rows(type.parameters, "", out);
    out += "\n";
  }
  return out + fmt::format("```json\n{}```\n\n", graph_text(example_graph(registry, type)));
}

/// Families with their node types.
std::map<std::string, std::vector<const NodeType*>> families(const Registry& registry) {
  std::map<std::string, std::vector<const NodeType*>> out;
  for (const auto& name : registry.names()) out[family_of(name)].push_back(registry.find(name));
  return out;
}

std::string links_to(const Registry& registry, const PortType& type, std::vector<PortSpec> NodeType::*ports) {
  std::vector<std::string> links;
  for (const auto& name : registry.names()) {
    const auto& all = registry.find(name)->*ports;
    if (std::any_of(all.begin(), all.end(), [&](const PortSpec& port) { return port.type == type; }))
      links.push_back(link(name));
  }
  return fmt::format("{}", fmt::join(links, ", "));
}

constexpr const char* made_by =
    "Written by `talkgraph reference -o docs/reference` from the descriptions in the program: change those.\n\n";

std::string index_page(const Registry& registry) {
  std::string out = "# Reference\n\n";
  out += made_by;
  out +=
      "`talkgraph node TYPE` shows the same on the terminal; [graphs.md](../graphs.md) explains the language. An "
      "example "
      "has the node in question first, then what feeds it; `talkgraph node TYPE --example` prints it alone, to be run. "
      "Where it reads files, `talkgraph samples` writes them.\n\n";
  for (const auto& [family, types] : families(registry)) {
    out += fmt::format("## {}\n\n| node type | what it does |\n|---|---|\n", family);
    for (const auto* type : types) out += fmt::format("| {} | {} |\n", link(type->name), escaped(type->summary));
    out += "\n";
  }
  out += "## Port types\n\n| type | given by | taken by |\n|---|---|---|\n";
  auto types = registry.port_types();
  std::sort(types.begin(), types.end(), [](const PortType& a, const PortType& b) { return a.name < b.name; });
  for (const auto& type : types)
    out += fmt::format("| {} | {} | {} |\n", type.name, links_to(registry, type, &NodeType::outputs),
                       links_to(registry, type, &NodeType::inputs));
  return out;
}

}  // namespace

std::string list_nodes(const Registry& registry, const std::string& word) {
  std::string out;
  for (const auto& name : registry.names()) {
    const NodeType& type = *registry.find(name);
    if (!speaks_of(name, word) && !speaks_of(type.summary, word)) continue;
    out += fmt::format("{:<28} {}\n", name, type.summary);
  }
  if (out.empty()) throw std::invalid_argument(fmt::format("no node type speaks of \"{}\"", word));
  return out;
}

const NodeType& known_type(const Registry& registry, const std::string& name) {
  if (const NodeType* type = registry.find(name)) return *type;
  std::string hint = did_you_mean(name, registry.names());
  for (const auto& known : registry.names())
    if (hint.empty() && known.ends_with("." + name)) hint = fmt::format(" (did you mean \"{}\"?)", known);
  throw std::invalid_argument(fmt::format("unknown node type \"{}\"{}", name, hint));
}

std::string show_node(const Registry& registry, const NodeType& type) {
  Lines lines;
  const auto heading = [&](const char* text) { lines.all.emplace_back(std::string("  ") + text, ""); };
  lines.all.emplace_back(fmt::format("{} (version {}): {}", type.name, type.version, type.summary), "");
  for (const auto& note : notes(type)) heading(note.c_str());
  const auto port = [&](const PortSpec& spec, const std::string& kind) {
    lines.all.emplace_back("    " + spec.name, kind + (spec.doc.empty() ? "" : ": " + spec.doc));
  };
  if (!type.inputs.empty()) heading("inputs");
  for (const auto& spec : type.inputs) port(spec, input_type(spec));
  heading("outputs");
  for (const auto& spec : type.outputs) port(spec, output_type(spec, type));
  if (!type.parameters.empty()) heading("parameters");
  add_parameters(type.parameters, "    ", lines);
  try {
    const Json example = example_graph(registry, type);
    return fmt::format("{}  example: {}\n{}", lines.str(), commands(type, reads_samples(example)),
                       indented(graph_text(example), "    "));
  } catch (const std::runtime_error& e) {
    return fmt::format("{}  {}\n", lines.str(), e.what());
  }
}

std::map<std::string, std::string> reference_pages(const Registry& registry) {
  std::map<std::string, std::string> pages = {{"README.md", index_page(registry)}};
  for (const auto& [family, types] : families(registry)) {
    std::string& page = pages[family + ".md"];
    page = fmt::format("# {}\n\n{}", family, made_by);
    for (const auto* type : types) page += section(registry, *type);
    page.pop_back();
  }
  return pages;
}

}  // namespace talkgraph::cli
