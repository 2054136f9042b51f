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
    if (!std::filesystem::is_regular_file(file.path) || is_series(file.path)) {
      const char* wrong = is_series(file.path) ? "is a series, which cannot be part of one" : "is no file";
      diagnostics_.error(json.place, fmt::format("series: {} {}", file.path, wrong));
      return {};
    }
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

constexpr const char* not_run = "not run";

/// "finished", "not run", "1 of 3 runs finished, 1 failed".
std::string state_of(const ExperimentSeries::Part& part) {
  const auto count = [&](TrialResult::Status status) {
    return static_cast<std::size_t>(std::count_if(part.results.begin(), part.results.end(),
                                                  [&](const TrialResult& r) { return r.status == status; }));
  };
  const auto all = part.experiment.trials.size(), finished = count(TrialResult::Status::finished),
             failed = count(TrialResult::Status::failed);
  if (finished == all) return "finished";
  if (finished + failed + count(TrialResult::Status::stopped) == 0) return not_run;
  return fmt::format("{} of {} runs finished{}", finished, all, failed == 0 ? "" : fmt::format(", {} failed", failed));
}

std::string anchor_of(const ExperimentSeries::Part& part) { return "experiment-" + url_of(part.experiment.name); }

/// Links to sections and experiments, with how far these are.
std::string contents(const ExperimentSeries& series) {
  std::string out = "<nav>\n<h2>Contents</h2>\n<ol>\n";
  for (std::size_t s = 0; s < series.sections.size(); ++s) {
    const auto& section = series.sections[s];
    out += fmt::format("<li><a href=\"#section-{}\">{}</a>\n<ul>\n", s + 1, escape_markup(section.title));
    for (const auto& part : section.parts)
      out += fmt::format("<li><a href=\"#{}\">{}</a>: {}</li>\n", anchor_of(part), escape_markup(part.experiment.name),
                         state_of(part));
    out += "</ul></li>\n";
  }
  return out + "</ol>\n</nav>\n";
}

/// What the measures of all experiments are, each once.
std::vector<Meaning> meanings_of(const ExperimentSeries& series) {
  std::vector<Meaning> all;
  for (const auto& section : series.sections)
    for (const auto& part : section.parts)
      for (const auto& meaning : meanings(part.experiment, part.graphs, part.results))
        if (std::find(all.begin(), all.end(), meaning) == all.end()) all.push_back(meaning);
  return all;
}

std::string html_part(const ExperimentSeries::Part& part) {
  const auto& [experiment, graphs, results] = part;
  const std::string state = state_of(part);
  return fmt::format("<h3 id=\"{}\">{}</h3>\n{}", anchor_of(part), escape_markup(experiment.name),
                     paragraphs(experiment.description)) +
         (state == not_run ? "<p>It has not been run.</p>\n"
                           : fmt::format("<p><a href=\"{}/experiment.html\">Its own page</a> has every run: {}.</p>\n",
                                         url_of(experiment.name), state)) +
         html_results(experiment, graphs, results, experiment.name + "/");
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
  std::string page = html_open(series.name, series.description) + contents(series) + html_meanings(meanings_of(series));
  for (std::size_t s = 0; s < series.sections.size(); ++s) {
    const auto& section = series.sections[s];
    page += fmt::format("<h2 id=\"section-{}\">{}</h2>\n{}", s + 1, escape_markup(section.title),
                        paragraphs(section.text)) +
            table_of(section.words);
    for (const auto& part : section.parts) page += html_part(part);
  }
  return page + html_close();
}

}  // namespace talkgraph
