#include "experiment/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "graph/draft.h"
#include "graph/key.h"
#include "nodes/types/report.h"

namespace talkgraph {
namespace {

using Kind = LocatedJson::Kind;

constexpr std::size_t most_trials = 10'000;
constexpr std::size_t longest_name = 80;

const std::vector<std::string> file_keys = {"$schema", "description", "graph",    "set",  "vary",
                                            "repeats", "seeds",       "tabulate", "plot", "show"};

/// Columns of the results, which no factor can be called.
const std::set<std::string> result_columns = {"trial", "seed", "status",  "output", "item", "row", "measure", "value",
                                              "n",     "over", "partial", "mean",   "std",  "low", "high",    "p"};

/// A parameter of the graph by its whole path, so that it is the same however it is named.
std::string whole_path(const std::string& path) {
  return path.find('.') == std::string::npos && path != "seed" ? "parameters." + path + ".default" : path;
}

/// Whether what is set at `path` is replaced by what is set at `other`: the same, or what it is part of.
bool is_within(const std::string& path, const std::string& other) {
  return path == other || path.starts_with(other + ".");
}

/// What varies at a time: each level changes the graph and gives a cell to each column.
struct Axis {
  struct Level {
    std::vector<Json> cells;
    std::vector<Change> changes;
  };
  std::vector<std::string> columns;
  std::vector<Level> levels;
};

/// As it stands in tables and names: a text without its quotes.
std::string text_of(const Json& cell) { return cell.is_string() ? cell.get<std::string>() : cell.dump(); }

LocatedJson number_at(double v, const Place& place) {
  const bool whole = v == std::round(v) && std::abs(v) < 1e15;
  return located(whole ? Json(static_cast<std::int64_t>(v)) : Json(v), place);
}

class Reader {
 public:
  explicit Reader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  Experiment read(const LocatedJson& json) {
    Experiment out;
    if (!detail::expect_object(json, "an experiment", diagnostics_)) return out;
    detail::check_keys(json, file_keys, "experiment", diagnostics_);
    if (const auto* graph = json.find("graph")) {
      if (const auto text = detail::read_graph(graph->value, diagnostics_)) out.graph = text->name;
    } else {
      diagnostics_.error(json.place, "experiment: \"graph\" must name the graph that is run");
    }
    read_member(json, "description", out.description);
    read_member(json, "plot", out.plot);
    out.tabulate = outputs(json, "tabulate");
    out.show = outputs(json, "show");
    if (out.tabulate.names.empty() && out.show.names.empty())
      diagnostics_.error(
          json.place,
          "experiment: \"tabulate\" must name outputs of the graph that are tables or scores, or \"show\" some "
          "that are clips or pictures");
    if (const auto* vary = json.find("vary")) out.vary = vary->key_place;
    for (const char* key : {"repeats", "seeds"})
      if (const auto* m = json.find(key)) out.repeats = m->key_place;
    if (const auto* set = json.find("set")) out.set = changes_of(set->value, "experiment: \"set\"");
    lay_out(axes(json), seeds(json), json.place, out);
    out.varied = std::move(varied_);
    if (out.repeats.source) out.varied.emplace("seed", out.repeats);
    return out;
  }

 private:
  template <class T>
  void read_member(const LocatedJson& json, const char* key, T& value, const Range& range = {}) {
    if (const auto* m = json.find(key))
      detail::read_parameter(m->value, value, range, fmt::format("experiment: \"{}\"", key), diagnostics_);
  }

  NamedOutputs outputs(const LocatedJson& json, const char* key) {
    NamedOutputs out;
    read_member(json, key, out.names);
    if (const auto* m = json.find(key)) out.place = m->value.place;
    if (std::set(out.names.begin(), out.names.end()).size() < out.names.size())
      diagnostics_.error(out.place, fmt::format("experiment: \"{}\" names an output twice", key));
    return out;
  }

  std::vector<Change> changes_of(const LocatedJson& json, const std::string& subject) {
    std::vector<Change> changes;
    if (detail::expect_object(json, subject, diagnostics_))
      for (const auto& m : json.members) changes.push_back({m.key, m.value});
    return changes;
  }

  std::vector<std::int64_t> seeds(const LocatedJson& json) {
    std::vector<std::int64_t> seeds;
    read_member(json, "seeds", seeds, {0, 9e15, false});
    const auto* repeats = json.find("repeats");
    if (repeats && json.find("seeds"))
      return diagnostics_.error(repeats->key_place, "experiment: give either \"repeats\" or \"seeds\""), seeds;
    int count = 0;
    read_member(json, "repeats", count, {1, most_trials, false});
    for (int i = 1; i <= count; ++i) seeds.push_back(i);
    if (std::set(seeds.begin(), seeds.end()).size() < seeds.size())
      diagnostics_.error(json.find("seeds")->value.place, "experiment: the same seed twice");
    return seeds;
  }

  std::vector<Axis> axes(const LocatedJson& json) {
    std::vector<Axis> all;
    const auto* vary = json.find("vary");
    if (!vary || !detail::expect_object(vary->value, "experiment: \"vary\"", diagnostics_)) return all;
    for (const auto& m : vary->value.members) {
      const auto said = diagnostics_.messages().size();
      Axis axis = read_axis(m.key, m.value, fmt::format("\"{}\"", m.key));
      if (axis.levels.empty() && diagnostics_.messages().size() == said)
        diagnostics_.error(m.value.place, fmt::format("\"{}\" has no values", m.key));
      std::set<std::string> seen;
      for (const auto& level : axis.levels)
        if (!seen.insert(Json(level.cells).dump()).second)
          diagnostics_.error(m.value.place,
                             fmt::format("\"{}\" has the value {} twice", m.key, fmt::join(texts(level.cells), ", ")));
      check_names(axis, m.key_place);
      check_paths(axis, m);
      all.push_back(std::move(axis));
    }
    return all;
  }

  void check_names(const Axis& axis, const Place& place) {
    for (const auto& column : axis.columns)
      if (result_columns.contains(column))
        diagnostics_.error(place, fmt::format("results have a column \"{}\" already: {}", column,
                                              column == "seed" ? "name seeds in \"seeds\", beside \"vary\""
                                                               : "give the factor another name, and its \"path\""));
      else if (!columns_.insert(column).second)
        diagnostics_.error(place, fmt::format("two factors are called \"{}\"", column));
  }

  /// What two factors set, only the second one would.
  void check_paths(const Axis& axis, const LocatedJson::Member& factor) {
    std::set<std::string> own, twice;
    for (const auto& level : axis.levels) {
      std::set<std::string> of_level;
      for (const auto& change : level.changes) {
        const std::string path = whole_path(change.path);
        if (!of_level.insert(path).second || varied_.contains(path)) twice.insert(change.path);
      }
      own.merge(of_level);
    }
    for (const auto& path : twice)
      diagnostics_.error(factor.key_place,
                         fmt::format("\"{}\" sets \"{}\", which is set twice then", factor.key, path));
    if (own.contains("seed") && factor.key != "seed")
      diagnostics_.error(factor.key_place, fmt::format("\"{}\" sets the seed: name seeds in \"seeds\"", factor.key));
    for (const auto& path : own) varied_.emplace(path, factor.key_place);
  }

  static std::vector<std::string> texts(const std::vector<Json>& cells) {
    std::vector<std::string> out;
    for (const auto& cell : cells) out.push_back(text_of(cell));
    return out;
  }

  Axis read_axis(const std::string& name, const LocatedJson& json, const std::string& subject) {
    if (json.is(Kind::object) && json.find("levels")) return named_levels(name, json, subject);
    if (json.is(Kind::object) && json.find("together")) return moving_together(json, subject);
    std::string path = name;
    if (json.is(Kind::object))
      if (const auto* m = json.find("path")) detail::read_parameter(m->value, path, {}, subject, diagnostics_);
    Axis axis{{name}, {}};
    for (const auto& value : values(json, subject)) axis.levels.push_back({{value.plain()}, {{path, value}}});
    return axis;
  }

  /// {"levels": {"MFCC": {path: value, ...}, "PLP": {...}}}
  Axis named_levels(const std::string& name, const LocatedJson& json, const std::string& subject) {
    detail::check_keys(json, {"levels"}, subject, diagnostics_);
    Axis axis{{name}, {}};
    const auto& levels = json.find("levels")->value;
    if (!detail::expect_object(levels, subject + ": \"levels\"", diagnostics_)) return axis;
    for (const auto& m : levels.members)
      axis.levels.push_back({{m.key}, changes_of(m.value, fmt::format("{}: level \"{}\"", subject, m.key))});
    return axis;
  }

  /// {"together": {path: [a, b], path: [c, d]}}: a with c, b with d.
  Axis moving_together(const LocatedJson& json, const std::string& subject) {
    detail::check_keys(json, {"together"}, subject, diagnostics_);
    Axis axis;
    const auto& lists = json.find("together")->value;
    if (!detail::expect_object(lists, subject + ": \"together\"", diagnostics_)) return axis;
    for (const auto& m : lists.members) {
      const auto list = values(m.value, fmt::format("{}: \"{}\"", subject, m.key));
      if (axis.columns.empty()) axis.levels.resize(list.size());
      if (list.size() != axis.levels.size())
        diagnostics_.error(m.value.place,
                           fmt::format("{}: what moves together must be equally long: {} has {}, {} has {}", subject,
                                       axis.columns[0], axis.levels.size(), m.key, list.size()));
      axis.columns.push_back(m.key);
      for (std::size_t i = 0; i < std::min(list.size(), axis.levels.size()); ++i) {
        axis.levels[i].cells.push_back(list[i].plain());
        axis.levels[i].changes.push_back({m.key, list[i]});
      }
    }
    return axis;
  }

  /// A list, {"values": list}, or a range {"from", "to", "step" or "count", "scale"}.
  std::vector<LocatedJson> values(const LocatedJson& json, const std::string& subject) {
    if (json.is(Kind::array)) return json.items;
    if (!json.is(Kind::object))
      return detail::complain_type(json, "a list or a range", subject, diagnostics_), std::vector<LocatedJson>{};
    detail::check_keys(json, {"path", "values", "from", "to", "step", "count", "scale"}, subject, diagnostics_);
    const auto* list = json.find("values");
    if (!list) return range(json, subject);
    if (list->value.is(Kind::array)) return list->value.items;
    return detail::complain_type(list->value, "a list", subject + ": \"values\"", diagnostics_),
           std::vector<LocatedJson>{};
  }

  std::vector<LocatedJson> range(const LocatedJson& json, const std::string& subject) {
    double from = 0, to = 0, step = 0;
    int count = 0;
    std::string scale = "linear";
    const auto read = [&](const char* key, auto& value, const Range& limits = {}) {
      if (const auto* m = json.find(key))
        detail::read_parameter(m->value, value, limits, fmt::format("{}: \"{}\"", subject, key), diagnostics_);
      return json.find(key) != nullptr;
    };
    const bool has_from = read("from", from), has_to = read("to", to);
    const bool has_step = read("step", step, {0, INFINITY, true});
    const bool has_count = read("count", count, {1, most_trials, false});
    read("scale", scale);
    const auto wrong = [&](const std::string& text) {
      diagnostics_.error(json.place, fmt::format("{}: {}", subject, text));
      return std::vector<LocatedJson>{};
    };
    if (!has_from || !has_to || has_step == has_count)
      return wrong("a range needs \"from\", \"to\" and either \"step\" or \"count\"");
    if (scale != "linear" && scale != "log") return wrong("\"scale\" must be linear or log");
    if (scale == "log" && (has_step || from <= 0 || to <= 0))
      return wrong("a range on a log scale needs a \"count\" and limits above 0");
    if (has_step) {
      if (!(step > 0)) return {};  // said already
      if (to < from) return wrong("\"to\" must not be below \"from\"");
      const double steps = std::floor((to - from) / step * (1 + 1e-12) + 1e-9);
      if (steps >= most_trials) return wrong(fmt::format("more than {} values", most_trials));
      count = static_cast<int>(steps) + 1;
    }
    std::vector<LocatedJson> out;
    for (int i = 0; i < count; ++i) {
      const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
      const double v = has_step         ? from + i * step
                       : scale == "log" ? from * std::pow(to / from, share)
                                        : from + share * (to - from);
      // Twelve digits, so that 0.1 + 2 * 0.1 is 0.3.
      out.push_back(number_at(std::stod(fmt::format("{:.12g}", v)), json.place));
    }
    return out;
  }

  /// All combinations, the first factor slowest, the seed fastest.
  void lay_out(const std::vector<Axis>& axes, const std::vector<std::int64_t>& seeds, const Place& place,
               Experiment& out) {
    double trials = static_cast<double>(std::max<std::size_t>(seeds.size(), 1));
    for (const auto& axis : axes) {
      out.factors.insert(out.factors.end(), axis.columns.begin(), axis.columns.end());
      trials *= static_cast<double>(axis.levels.size());
    }
    if (trials > most_trials)
      return diagnostics_.error(
          place, fmt::format("experiment: {} runs; more than {} are surely a mistake", trials, most_trials));
    std::vector<Trial> all(1);
    for (const auto& axis : axes) all = combine(all, axis);
    out.settings = all.size();
    for (std::size_t s = 0; s < all.size(); ++s) {
      all[s].setting = s;
      if (seeds.empty()) out.trials.push_back(all[s]);
      for (const auto seed : seeds) {
        Trial& trial = out.trials.emplace_back(all[s]);
        trial.seed = seed;
        trial.changes.push_back({"seed", located(seed, place)});
      }
    }
    name_trials(out);
  }

  static std::vector<Trial> combine(const std::vector<Trial>& trials, const Axis& axis) {
    std::vector<Trial> out;
    for (const auto& trial : trials)
      for (const auto& level : axis.levels) {
        Trial& next = out.emplace_back(trial);
        next.levels.insert(next.levels.end(), level.cells.begin(), level.cells.end());
        next.changes.insert(next.changes.end(), level.changes.begin(), level.changes.end());
      }
    return out;
  }

  /// After the settings, so that a trial keeps its folder when the experiment grows.
  static void name_trials(Experiment& out) {
    std::set<std::string> taken;
    for (auto& trial : out.trials) {
      std::vector<std::string> parts;
      for (std::size_t f = 0; f < out.factors.size(); ++f)
        parts.push_back(
            fmt::format("{}={}", out.factors[f].substr(out.factors[f].rfind('.') + 1), text_of(trial.levels[f])));
      if (trial.seed) parts.push_back(fmt::format("seed={}", *trial.seed));
      const std::string full = parts.empty() ? "run" : fmt::format("{}", fmt::join(parts, ","));
      trial.name = full.substr(0, longest_name);
      for (auto& c : trial.name)
        if (!std::isalnum(static_cast<unsigned char>(c)) &&
            std::string_view("=,.-_+").find(c) == std::string_view::npos)
          c = '-';
      if (trial.name != full || !taken.insert(trial.name).second)
        trial.name += "-" + KeyMaker().add(full).key().str().substr(0, 8);
    }
  }

  Diagnostics& diagnostics_;
  std::set<std::string> columns_;        ///< of the factors so far
  std::map<std::string, Place> varied_;  ///< whole paths that they set
};

/// Two trials that would do the same.
void check_distinct(const Experiment& experiment, const std::vector<Graph>& graphs, Diagnostics& diagnostics) {
  std::map<Key, std::size_t> seen;
  for (std::size_t t = 0; t < graphs.size(); ++t) {
    const auto [first, is_new] = seen.emplace(KeyMaker().add(graphs[t].resolved.dump()).key(), t);
    if (!is_new)
      return diagnostics.error(experiment.vary,
                               fmt::format("the runs \"{}\" and \"{}\" are the same: what differs "
                                           "between them does not change the graph",
                                           experiment.trials[first->second].name, experiment.trials[t].name));
  }
}

/// Repeats that would all give the same, which would look like certainty.
void check_repeats(const Experiment& experiment, const std::vector<Graph>& graphs, Diagnostics& diagnostics) {
  const auto draws = [](const Graph& graph) {
    return std::any_of(graph.nodes.begin(), graph.nodes.end(), [](const auto& node) { return node.type->uses_random; });
  };
  if (experiment.trials.size() > experiment.settings && std::none_of(graphs.begin(), graphs.end(), draws))
    diagnostics.error(experiment.repeats,
                      "repeats with other seeds would all give the same: no node of the graph draws random numbers");
}

/// Complaints about what is to be tabulated and shown.
void check_outputs(const Experiment& experiment, const Graph& graph, Diagnostics& diagnostics) {
  const auto check = [&](const NamedOutputs& outputs, const std::vector<std::string_view>& types, const char* what) {
    std::vector<std::string> known;
    for (const auto& output : graph.outputs) known.push_back(output.name);
    for (const auto& name : outputs.names) {
      const auto it = std::find(known.begin(), known.end(), name);
      if (it == known.end()) {
        diagnostics.error(outputs.place, fmt::format("experiment: \"{}\" names \"{}\", but {} has no such output{}",
                                                     what, name, graph.name, did_you_mean(name, known)));
        continue;
      }
      const auto& source = graph.outputs[static_cast<std::size_t>(it - known.begin())].source;
      const auto type = graph.nodes[static_cast<std::size_t>(source.node)]
                            .type->outputs[static_cast<std::size_t>(source.port)]
                            .type.name;
      if (std::find(types.begin(), types.end(), type) == types.end())
        diagnostics.error(outputs.place,
                          fmt::format("experiment: \"{}\" names the output \"{}\", which is of type {}, not {}", what,
                                      name, type, fmt::join(types, " or ")));
    }
  };
  check(experiment.tabulate, {port_type<Table>.name, port_type<Scores>.name}, "tabulate");
  check(experiment.show, {port_type<Artifact>.name, port_type<Plot>.name}, "show");
}

}  // namespace

std::optional<Experiment> load_experiment(const std::filesystem::path& file, Diagnostics& diagnostics) {
  const auto json = detail::parse_file(file, diagnostics);
  if (!json) return {};
  Experiment experiment = Reader(diagnostics).read(*json);
  experiment.name = file.stem().string();
  if (!diagnostics.ok()) return {};
  return experiment;
}

void set_in_all_runs(Experiment& experiment, const std::vector<std::string>& sets, Diagnostics& diagnostics) {
  for (const auto& set : sets) {
    auto change = detail::parse_set(set, diagnostics);
    if (!change) continue;
    const std::string path = whole_path(change->path);
    for (const auto& [varied, place] : experiment.varied)
      if (is_within(path, varied))
        diagnostics.error(place, fmt::format("--set {} cannot hold in all runs: what it sets varies here", set));
    std::erase_if(experiment.set, [&](const Change& fixed) { return is_within(whole_path(fixed.path), path); });
    experiment.set.push_back(*std::move(change));
  }
}

bool varies(const Experiment& experiment, const Change& set) {
  return std::ranges::any_of(experiment.varied, [&](const auto& varied) {
    return is_within(whole_path(set.path), varied.first) || is_within(varied.first, whole_path(set.path));
  });
}

std::optional<Graph> load_trial(const Experiment& experiment, const Trial& trial, const Registry& registry,
                                Diagnostics& diagnostics) {
  std::vector<Change> changes = experiment.set;
  changes.insert(changes.end(), trial.changes.begin(), trial.changes.end());
  return load_graph(experiment.graph, registry, diagnostics, {{}, std::move(changes)});
}

std::optional<std::vector<Graph>> load_trials(const Experiment& experiment, const Registry& registry,
                                              Diagnostics& diagnostics) {
  std::vector<Graph> graphs;
  std::set<std::string> said;
  for (const auto& trial : experiment.trials) {
    Diagnostics own;
    auto graph = load_trial(experiment, trial, registry, own);
    if (graph) check_outputs(experiment, *graph, own);
    for (const auto& m : own.messages())
      if (said.insert(fmt::format("{}:{}:{}", m.place.line, m.place.column, m.text)).second)
        diagnostics.error(m.place, m.text);
    if (graph) graphs.push_back(*std::move(graph));
  }
  if (diagnostics.ok()) {
    check_repeats(experiment, graphs, diagnostics);
    check_distinct(experiment, graphs, diagnostics);
  }
  if (!diagnostics.ok()) return {};
  return graphs;
}

}  // namespace talkgraph
