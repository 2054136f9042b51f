#include "experiment/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "experiment/page.h"
#include "graph/draft.h"
#include "nodes/plot/svg.h"
#include "nodes/report/page.h"

namespace talkgraph {
namespace {

class Reader {
 public:
  Reader(const Registry& registry, const std::vector<std::string>& sets, Diagnostics& diagnostics)
      : registry_(registry), sets_(sets), diagnostics_(diagnostics) {}

  ExperimentSeries read(const LocatedJson& json) {
    ExperimentSeries series;
    if (!detail::expect_object(json, "a series", diagnostics_)) return series;
    detail::check_keys(json, {"$schema", "description", "sections"}, "series", diagnostics_);
    read_text(json, "description", series.description);
    const auto& sections = json.find("sections")->value;
    if (!sections.is(LocatedJson::Kind::array) || sections.items.empty())
      diagnostics_.error(sections.place, "series: \"sections\" must be a list of at least one section");
    for (const auto& section : sections.items) series.sections.push_back(section_of(section));
    for (const auto& set : sets_)
      if (!taken_.contains(set)) complain_of(set, series);
    return series;
  }

 private:
  void read_text(const LocatedJson& json, const char* key, std::string& text) {
    if (const auto* m = json.find(key))
      detail::read_parameter(m->value, text, {}, fmt::format("series: \"{}\"", key), diagnostics_);
  }

  ExperimentSeries::Section section_of(const LocatedJson& json) {
    ExperimentSeries::Section section;
    if (!detail::expect_object(json, "a section", diagnostics_)) return section;
    detail::check_keys(json, {"title", "text", "table", "experiments"}, "section", diagnostics_);
    read_text(json, "title", section.title);
    read_text(json, "text", section.text);
    if (const auto* m = json.find("table")) section.words = words_of(m->value);
    const auto* experiments = json.find("experiments");
    if (!experiments) return section;
    if (!experiments->value.is(LocatedJson::Kind::array)) {
      detail::complain_type(experiments->value, "a list of files", "section: \"experiments\"", diagnostics_);
      return section;
    }
    for (const auto& file : experiments->value.items)
      if (auto part = part_of(file)) section.parts.push_back(*std::move(part));
    return section;
  }

  ExperimentSeries::Words words_of(const LocatedJson& json) {
    ExperimentSeries::Words words;
    if (!detail::expect_object(json, "section: \"table\"", diagnostics_)) return words;
    detail::check_keys(json, {"columns", "rows"}, "section: \"table\"", diagnostics_);
    if (const auto* m = json.find("columns"))
      detail::read_parameter(m->value, words.columns, {}, "section: \"columns\"", diagnostics_);
    for (const auto& row : detail::members_of(json, "rows")) {
      auto& cells = words.rows.emplace_back(row.key, std::vector<std::string>{}).second;
      detail::read_parameter(row.value, cells, {}, fmt::format("section: row \"{}\"", row.key), diagnostics_);
      if (cells.size() != words.columns.size())
        diagnostics_.error(row.value.place, fmt::format("section: row \"{}\" has {} cells in {} columns", row.key,
                                                        cells.size(), words.columns.size()));
    }
    return words;
  }

  std::optional<ExperimentSeries::Part> part_of(const LocatedJson& json) {
    FilePath file;
    detail::read_parameter(json, file, {}, "section: \"experiments\"", diagnostics_);
    if (file.path.empty()) return {};
    auto experiment = load_experiment(file.path, diagnostics_);
    if (!experiment) return {};
    if (!names_.insert(experiment->name).second) {
      diagnostics_.error(json.place, fmt::format("series: two experiments are called \"{}\"", experiment->name));
      return {};
    }
    std::vector<std::string> own;
    std::copy_if(sets_.begin(), sets_.end(), std::back_inserter(own),
                 [&](const std::string& set) { return takes(*experiment, set); });
    set_in_all_runs(*experiment, own, diagnostics_);
    auto graphs = load_trials(*experiment, registry_, diagnostics_);
    if (!graphs) return {};
    return ExperimentSeries::Part{*std::move(experiment), *std::move(graphs), {}};
  }

  bool takes(const Experiment& experiment, const std::string& set) {
    Diagnostics unheard;
    if (!first_graph(experiment, set, unheard)) return false;
    taken_.insert(set);
    return true;
  }

  std::optional<Graph> first_graph(Experiment experiment, const std::string& set, Diagnostics& diagnostics) {
    const auto change = detail::parse_set(set, diagnostics);
    if (!change) return {};
    experiment.set.push_back(*change);
    return load_trial(experiment, experiment.trials[0], registry_, diagnostics);
  }

  /// Of a change that no graph takes, as the first one says it.
  void complain_of(const std::string& set, const ExperimentSeries& series) {
    for (const auto& section : series.sections)
      for (const auto& part : section.parts) {
        first_graph(part.experiment, set, diagnostics_);
        return;
      }
  }

  const Registry& registry_;
  const std::vector<std::string>& sets_;
  Diagnostics& diagnostics_;
  std::set<std::string> names_, taken_;
};

/// Paragraphs stand apart by empty lines.
std::string paragraphs(const std::string& text) {
  std::string out;
  for (std::size_t from = 0; from < text.size();) {
    const auto end = std::min(text.find("\n\n", from), text.size());
    out += "<p>" + escape_markup(text.substr(from, end - from)) + "</p>\n";
    from = end + 2;
  }
  return out;
}

std::string table_of(const ExperimentSeries::Words& words) {
  if (words.rows.empty()) return "";
  const auto cells = [](const char* open, const std::vector<std::string>& texts, const char* close) {
    std::string out;
    for (const auto& text : texts) out += open + escape_markup(text) + close;
    return out;
  };
  std::string out = "<div class=\"wide\"><table>\n<thead><tr><th></th>" +
                    cells("<th scope=\"col\" class=\"text\">", words.columns, "</th>") + "</tr></thead>\n<tbody>\n";
  for (const auto& [name, row] : words.rows)
    out += fmt::format("<tr><th scope=\"row\">{}</th>{}</tr>\n", escape_markup(name),
                       cells("<td class=\"text\">", row, "</td>"));
  return out + "</tbody>\n</table></div>\n";
}

std::string state_of(const ExperimentSeries::Part& part) {
  const auto ended = std::count_if(part.results.begin(), part.results.end(),
                                   [](const TrialResult& r) { return r.status == TrialResult::Status::finished; });
  const auto all = part.experiment.trials.size();
  return static_cast<std::size_t>(ended) == all ? "" : fmt::format("{} of {} runs finished so far. ", ended, all);
}

}  // namespace

bool is_series(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) return false;
  std::ifstream in(file, std::ios::binary);
  const Json json = Json::parse(in, nullptr, false);
  return json.is_object() && json.contains("sections");
}

std::optional<ExperimentSeries> load_series(const std::filesystem::path& file, const Registry& registry,
                                            const std::vector<std::string>& sets, Diagnostics& diagnostics) {
  const auto json = detail::parse_file(file, diagnostics);
  if (!json) return {};
  ExperimentSeries series = Reader(registry, sets, diagnostics).read(*json);
  series.name = file.stem().string();
  if (!diagnostics.ok()) return {};
  return series;
}

std::string series_page(const ExperimentSeries& series) {
  std::string page = html_open(series.name, series.description);
  for (const auto& section : series.sections) {
    page += fmt::format("<h2>{}</h2>\n{}", escape_markup(section.title), paragraphs(section.text));
    page += table_of(section.words);
    for (const auto& part : section.parts) {
      const std::string name = escape_markup(part.experiment.name);
      page +=
          fmt::format("<h3>{0}</h3>\n{1}<p>{2}<a href=\"{0}/experiment.html\">Its own page</a> has every run.</p>\n",
                      name, paragraphs(part.experiment.description), state_of(part));
      page += html_results(part.experiment, part.results, part.experiment.name + "/");
    }
  }
  return page + html_close();
}

}  // namespace talkgraph
