#include "experiment/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "experiment/verdict.h"
#include "graph/differences.h"
#include "graph/output_file.h"
#include "nodes/plot/svg.h"
#include "nodes/report/page.h"

namespace talkgraph {
namespace {

constexpr std::size_t most_items = 4, most_measures = 12;

template <class T>
void add_once(std::vector<T>& list, const T& element) {
  if (std::find(list.begin(), list.end(), element) == list.end()) list.push_back(element);
}

std::string text_of(const Json& cell) { return cell.is_string() ? cell.get<std::string>() : cell.dump(); }

const Trial& first_of(const Experiment& experiment, std::size_t setting) {
  return *std::find_if(experiment.trials.begin(), experiment.trials.end(),
                       [&](const Trial& t) { return t.setting == setting; });
}

/// Whether a text level says by itself of which factor it is.
bool stands_alone(const Experiment& experiment, std::size_t factor, const Json& level) {
  if (!level.is_string()) return false;
  for (const auto& trial : experiment.trials)
    for (std::size_t f = 0; f < trial.levels.size(); ++f)
      if (f != factor && text_of(trial.levels[f]) == text_of(level)) return false;
  return true;
}

/// "latent 2, MFCC", without the factor `except`.
std::string setting_text(const Experiment& experiment, std::size_t setting, std::optional<std::size_t> except = {}) {
  std::vector<std::string> parts;
  const auto& levels = first_of(experiment, setting).levels;
  for (std::size_t f = 0; f < levels.size(); ++f)
    if (f != except)
      parts.push_back((stands_alone(experiment, f, levels[f]) ? "" : experiment.factors[f] + " ") + text_of(levels[f]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The first factor whose levels are numbers, more than one of them.
std::optional<std::size_t> number_factor(const Experiment& experiment) {
  for (std::size_t f = 0; f < experiment.factors.size(); ++f) {
    std::set<double> values;
    bool numbers = true;
    for (const auto& trial : experiment.trials) {
      numbers = numbers && trial.levels[f].is_number();
      if (numbers) values.insert(trial.levels[f].get<double>());
    }
    if (numbers && values.size() > 1) return f;
  }
  return {};
}

/// Estimates of one output, by measure, in the order in which they came.
struct OutputEstimates {
  std::string output;
  std::vector<std::string> measures;
  std::vector<const Estimate*> all;
};

std::vector<OutputEstimates> by_output(const std::vector<Estimate>& estimates) {
  std::vector<OutputEstimates> out;
  for (const auto& e : estimates) {
    auto it = std::find_if(out.begin(), out.end(), [&](const auto& o) { return o.output == e.output; });
    if (it == out.end()) it = out.insert(out.end(), OutputEstimates{e.output, {}, {}});
    add_once(it->measures, e.measure);
    it->all.push_back(&e);
  }
  return out;
}

std::string joined(const std::string& a, const std::string& b) { return a.empty() ? b : b.empty() ? a : a + ", " + b; }

double half_width(const Estimate& e) { return (e.high - e.low) / 2; }

void sort_by_x(Series& series) {
  std::vector<std::size_t> order(series.x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return series.x[a] < series.x[b]; });
  for (auto* values : {&series.x, &series.y, &series.spread}) {
    std::vector<double> sorted;
    for (const auto i : order) sorted.push_back((*values)[i]);
    *values = std::move(sorted);
  }
}

Panel line_panel(const Experiment& experiment, const OutputEstimates& estimates, const std::string& measure,
                 std::size_t factor) {
  Panel panel{measure, experiment.factors[factor], "", {}};
  for (const auto* e : estimates.all) {
    // Every panel has all series, so that they share their colours.
    const std::string name = joined(setting_text(experiment, e->setting, factor), e->row);
    auto it = std::find_if(panel.series.begin(), panel.series.end(), [&](const Series& s) { return s.name == name; });
    if (it == panel.series.end()) it = panel.series.insert(panel.series.end(), Series{name, {}, {}, {}});
    if (e->measure != measure) continue;
    it->x.push_back(first_of(experiment, e->setting).levels[factor].get<double>());
    it->y.push_back(e->mean);
    it->spread.push_back(half_width(*e));
  }
  for (auto& series : panel.series) sort_by_x(series);
  return panel;
}

BarPanel bar_panel(const Experiment& experiment, const OutputEstimates& estimates, const std::string& measure) {
  BarPanel panel{measure, {}};
  for (const auto* e : estimates.all)
    if (e->measure == measure)
      panel.bars.push_back({joined(setting_text(experiment, e->setting), e->row), e->mean, half_width(*e)});
  return panel;
}

std::string number_text(const Estimate& e) {
  return html_number({e.mean, e.deviation, e.low, e.high, e.p}, e.partial ? " *" : "");
}

/// "phones: transcript, features: MFCC".
std::string levels_text(const Experiment& experiment, std::size_t setting) {
  std::vector<std::string> parts;
  const auto& levels = first_of(experiment, setting).levels;
  for (std::size_t f = 0; f < levels.size(); ++f) parts.push_back(experiment.factors[f] + ": " + text_of(levels[f]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The name of a measure, which says what it is where that is known.
std::string measure_head(const std::string& measure, const std::vector<Meaning>& meanings) {
  const auto known =
      std::find_if(meanings.begin(), meanings.end(), [&](const auto& m) { return m.measure == measure; });
  if (known == meanings.end()) return escape_markup(measure);
  return fmt::format("<abbr title=\"{}\">{}</abbr>", escape_markup(known->text), escape_markup(measure));
}

/// The cells of one setting and row.
std::vector<std::string> score_cells(const OutputEstimates& estimates, std::size_t setting, const std::string& row) {
  std::vector<std::string> cells;
  for (const auto& measure : estimates.measures) {
    const auto it = std::find_if(estimates.all.begin(), estimates.all.end(), [&](const auto* e) {
      return e->setting == setting && e->row == row && e->measure == measure;
    });
    cells.push_back(number_cell(it == estimates.all.end() ? "–" : number_text(**it)));
  }
  return cells;
}

/// Where settings have several rows each, these stand below their levels; else levels are columns.
std::string score_table(const Experiment& experiment, const OutputEstimates& estimates,
                        const std::vector<Meaning>& meanings) {
  std::vector<std::pair<std::size_t, std::string>> names;  // setting, row
  std::set<std::size_t> settings;
  for (const auto* e : estimates.all) {
    add_once(names, {e->setting, e->row});
    settings.insert(e->setting);
  }
  const auto any = [&](auto is) { return std::any_of(estimates.all.begin(), estimates.all.end(), is); };
  const bool rows = any([](const auto* e) { return !e->row.empty(); });
  const bool apart = names.size() > settings.size() && !experiment.factors.empty();

  std::vector<std::string> head;
  if (rows) head.emplace_back("row");
  if (!apart)
    std::transform(experiment.factors.begin(), experiment.factors.end(), std::back_inserter(head), escape_markup);
  for (const auto& measure : estimates.measures) head.push_back(measure_head(measure, meanings));
  std::vector<std::vector<std::string>> lines;
  std::optional<std::size_t> above;
  for (const auto& [setting, row] : names) {
    if (apart && setting != above)
      lines.push_back({heading_cell(escape_markup(levels_text(experiment, setting)), head.size())});
    above = setting;
    auto& line = lines.emplace_back();
    if (rows) line.push_back(text_cell(escape_markup(row)));
    if (!apart)
      for (const auto& level : first_of(experiment, setting).levels)
        line.push_back(text_cell(escape_markup(text_of(level))));
    const auto cells = score_cells(estimates, setting, row);
    line.insert(line.end(), cells.begin(), cells.end());
  }
  return html_table(title_with_key(estimates.output, any([](const auto* e) { return is_significant(e->p); })), head,
                    lines);
}

/// "By acc ours is ahead of all others (p below 0.05) but theirs, 0.01 behind; it wins 12 recordings." Or "By acc ours
/// is the best, but significantly (p below 0.05) ahead of none; ..."
std::string verdict_text(const Verdict& verdict) {
  const auto bold = [](const std::string& row) { return "<b>" + escape_markup(row) + "</b>"; };
  std::vector<std::string> close;
  for (const auto& other : verdict.close)
    close.push_back(fmt::format("{}, {:.2g} behind", bold(other.row), other.behind));
  std::string text = fmt::format("By {} {} is ", escape_markup(verdict.score), bold(verdict.best));
  text += verdict.beaten > 0 ? "ahead of all others (p below 0.05)"
                             : "the best, but significantly (p below 0.05) ahead of none";
  if (verdict.beaten > 0 && !close.empty()) text += fmt::format(" but {}", fmt::join(close, "; "));
  if (!std::isnan(verdict.won)) text += fmt::format("; it wins {:g} recordings", verdict.won);
  return text + ".";
}

std::string verdict_list(const Experiment& experiment, const OutputEstimates& estimates) {
  std::string list;
  for (const Verdict& verdict : verdicts(estimates.all)) {
    const std::string levels = escape_markup(levels_text(experiment, verdict.setting));
    list += fmt::format("<li>{}{}</li>\n", levels.empty() ? "" : levels + ". ", verdict_text(verdict));
  }
  return list.empty() ? "" : "<ul>\n" + list + "</ul>\n";
}

/// Methods that others are tested against, by the tables of the graphs.
std::vector<std::string> tested_against(const std::vector<Graph>& graphs) {
  std::vector<std::string> methods;
  for (const auto& graph : graphs)
    for (const auto& node : graph.resolved["nodes"])
      if (node.value("type", "") == "statistics.methods" && node.contains("params"))
        if (const auto method = node["params"].value("against", ""); !method.empty()) add_once(methods, method);
  return methods;
}

/// Says what the numbers behind ± and below the others are.
std::string interval_note(const std::vector<Estimate>& estimates, const std::vector<std::string>& against) {
  std::size_t repeats = 0, items = 0;
  bool of_tables = false, tested = false, behind = false;
  for (const auto& e : estimates) {
    if (e.over == Estimate::Over::items)
      items = std::max(items, e.n);
    else
      repeats = std::max(repeats, e.n);
    of_tables = of_tables || e.over == Estimate::Over::table || !std::isnan(e.p);
    const bool of_best = e.measure.ends_with(" behind");
    behind = behind || (of_best && !std::isnan(e.p));
    tested = tested || (!of_best && !std::isnan(e.p));
  }
  std::string over, note;
  if (repeats > 1) over = fmt::format("{} repeats with seeds of their own", repeats);
  if (items > 1) over += fmt::format("{}{} items of one run", over.empty() ? "" : " or ", items);
  if (!over.empty())
    note = fmt::format(
        "Means over {}, after ± the standard deviation, below it the 95 % confidence interval of the mean (Student's "
        "t). ",
        over);
  if (of_tables)
    note +=
        "Of a table: after ± the standard deviation; below it, where the table gives them, the confidence interval of "
        "the mean, and p.";
  if (tested && !against.empty())
    note += escape_markup(fmt::format(" That p is of the signed-rank test against {}, sequence by sequence.",
                                      fmt::join(against, " or ")));
  if (behind)
    note +=
        " Behind is behind the method of the best mean, with p of Wilcoxon's signed-rank test of the two, sequence by "
        "sequence, corrected over all pairs of methods (Holm's correction unless the graph names another).";
  return note.empty() ? "One run of each setting: there are no confidence intervals." : note;
}

std::string figure_of(const Shown& shown, const std::string& label, const std::string& folder) {
  if (shown.value.type().type == port_type<Plot>) {
    auto plot = shown.value.get<Plot>();
    plot.title = label;
    return html_plot(plot);
  }
  auto artifact = shown.value.get<Artifact>();
  artifact.path = folder + artifact.path;
  return html_clip(label, artifact);
}

/// Clips under one heading.
struct Group {
  std::string heading;
  struct Entry {
    const Shown* shown;
    std::string label;
    const Trial* trial;
  };
  std::vector<Entry> entries;
};

/// What belongs together: the same item of an output by all settings, or, where there is one setting, of all outputs.
/// Of each output the items that most groups have, in their order.
std::vector<Group> groups_of(const Experiment& experiment, const std::vector<TrialResult>& results) {
  const bool by_item = experiment.settings == 1;
  std::vector<std::pair<std::string, std::string>> names;  // output (none where all are together), item
  std::map<std::pair<std::string, std::string>, Group> groups;
  std::set<std::tuple<std::string, std::string, std::size_t>> seen;
  for (std::size_t t = 0; t < results.size(); ++t)
    for (const auto& shown : results[t].shown) {
      const Trial& trial = experiment.trials[t];
      if (!seen.insert({shown.output, shown.item, trial.setting}).second) continue;
      const std::pair name(by_item && !shown.item.empty() ? "" : shown.output, shown.item);
      add_once(names, name);
      groups[name].heading = joined(name.first, name.second);
      groups[name].entries.push_back(
          {&shown, by_item ? shown.output : setting_text(experiment, trial.setting), &trial});
    }
  std::stable_sort(names.begin(), names.end(),
                   [&](const auto& a, const auto& b) { return groups[a].entries.size() > groups[b].entries.size(); });
  std::vector<Group> out;
  std::map<std::string, std::size_t> count;
  for (const auto& name : names)
    if (count[name.first]++ < most_items) out.push_back(std::move(groups[name]));
  return out;
}

/// Starts all clips of the group below it, with the sound of the first.
constexpr const char* play_all =
    "<p><button type=\"button\" onclick=\"this.parentElement.nextElementSibling.querySelectorAll('video').forEach((v, "
    "i) => { v.muted = i > 0; v.currentTime = 0; v.play(); })\">play all</button></p>\n";

std::string clips(const Experiment& experiment, const std::vector<TrialResult>& results, const std::string& folder) {
  std::string out;
  for (const auto& group : groups_of(experiment, results)) {
    std::string figures;
    for (const auto& entry : group.entries)
      figures += figure_of(*entry.shown, entry.label, folder + "trials/" + entry.trial->name + "/");
    const auto first = figures.find("<video");
    const bool several = first != std::string::npos && figures.find("<video", first + 1) != std::string::npos;
    out += fmt::format("<h4>{}</h4>\n{}<div class=\"clips\">\n{}</div>\n", escape_markup(group.heading),
                       several ? play_all : "", figures);
  }
  return out;
}

std::string trial_table(const Experiment& experiment, const std::vector<Graph>& graphs,
                        const std::vector<TrialResult>& results) {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t t = 0; t < results.size(); ++t) {
    const auto& trial = experiment.trials[t];
    const auto& result = results[t];
    std::string what = t == 0 ? "the others are compared with this one" : "nothing";
    std::vector<std::string> differ;
    if (t > 0)
      for (const char* part : {"nodes", "seed"})
        for (const auto& d : differences(graphs[0].resolved[part], graphs[t].resolved[part]))
          differ.push_back(escape_markup(d.starts_with(':') ? part + d : d));
    if (!differ.empty()) what = fmt::format("{}", fmt::join(differ, "<br>"));
    std::string status = status_text(result.status);
    if (!result.error.empty()) status += ": " + result.error;
    const bool ran = result.status != TrialResult::Status::waiting;
    const std::string name = escape_markup(trial.name);
    lines.push_back({text_cell(ran ? fmt::format("<a href=\"trials/{0}/\">{0}</a>", name) : name),
                     text_cell(escape_markup(status)), number_cell(fmt::format("{:.1f}", result.wall)),
                     number_cell(fmt::format("{}", result.calls)), number_cell(fmt::format("{}", result.loaded)),
                     text_cell("<small>" + what + "</small>")});
  }
  return "<h2>Runs</h2>\n" + html_table("How each went, and what it did differently",
                                        {"run", "status", "seconds", "calls", "found", "differs in"}, lines);
}

/// What is set in all runs, and is not varied in some: a line, folded where it is a long one.
std::string settings(const Experiment& experiment) {
  constexpr std::size_t in_sight = 6;
  std::vector<std::string> all;
  for (const auto& set : experiment.set)
    if (!varies(experiment, set))
      all.push_back(fmt::format("<code>{}</code>", escape_markup(set.path + "=" + text_of(set.value.plain()))));
  if (all.empty()) return "";
  std::string line = fmt::format("<p>In all runs {}.</p>\n", fmt::join(all, ", "));
  if (all.size() <= in_sight) return line;
  return fmt::format("<details><summary>What is set in all runs</summary>\n{}</details>\n", line);
}

}  // namespace

std::vector<Plot> plot_estimates(const Experiment& experiment, const std::vector<Estimate>& estimates) {
  std::vector<Plot> plots;
  const auto factor = number_factor(experiment);
  for (auto& of_output : by_output(estimates)) {
    auto& measures = of_output.measures;
    if (!experiment.plot.empty())
      std::erase_if(measures, [&](const auto& m) {
        return std::find(experiment.plot.begin(), experiment.plot.end(), m) == experiment.plot.end();
      });
    if (measures.size() > most_measures) measures.resize(most_measures);
    if (measures.empty()) continue;
    std::vector<Panel> lines;
    std::vector<BarPanel> bars;
    for (const auto& measure : measures) {
      if (factor)
        lines.push_back(line_panel(experiment, of_output, measure, *factor));
      else
        bars.push_back(bar_panel(experiment, of_output, measure));
    }
    plots.push_back({of_output.output,
                     factor ? draw_panels(of_output.output, lines, {2, 460, 300}) : draw_bars(of_output.output, bars)});
  }
  return plots;
}

std::vector<std::string> missing_measures(const Experiment& experiment, const std::vector<Estimate>& estimates) {
  std::vector<std::string> known, missing;
  for (const auto& e : estimates) add_once(known, e.measure);
  if (known.empty()) return {};
  for (const auto& measure : experiment.plot)
    if (std::find(known.begin(), known.end(), measure) == known.end())
      missing.push_back(fmt::format("There is no measure \"{}\" to plot{}.", measure, did_you_mean(measure, known)));
  return missing;
}

std::vector<Meaning> meanings(const Experiment& experiment, const std::vector<Graph>& graphs,
                              const std::vector<TrialResult>& results) {
  std::vector<std::string> measures;
  for (const auto& e : estimate(experiment, results)) add_once(measures, e.measure);
  return meanings_of(measures, graphs);
}

std::string html_results(const Experiment& experiment, const std::vector<Graph>& graphs,
                         const std::vector<TrialResult>& results, const std::string& folder) {
  const auto estimates = estimate(experiment, results);
  std::string html = settings(experiment);
  if (!estimates.empty()) html += "<p>" + interval_note(estimates, tested_against(graphs)) + "</p>\n";
  if (std::any_of(estimates.begin(), estimates.end(), [](const Estimate& e) { return e.partial; }))
    html += "<p>* Without items that failed: see the runs.</p>\n";
  for (const auto& missing : missing_measures(experiment, estimates)) html += "<p>" + escape_markup(missing) + "</p>\n";
  for (const auto& of_output : by_output(estimates))
    html += verdict_list(experiment, of_output) +
            score_table(experiment, of_output, meanings_of(of_output.measures, graphs));
  for (const auto& plot : plot_estimates(experiment, estimates)) html += html_plot(plot);
  return html + clips(experiment, results, folder);
}

std::string experiment_page(const Experiment& experiment, const std::vector<Graph>& graphs,
                            const std::vector<TrialResult>& results) {
  const auto finished = std::count_if(results.begin(), results.end(),
                                      [](const TrialResult& r) { return r.status == TrialResult::Status::finished; });
  std::string page = html_open(experiment.name, experiment.description);
  page += fmt::format(
      "<p>{} of {} runs finished, of <code>{}</code>. All numbers: <a href=\"results.csv\">results.csv</a>, "
      "<a href=\"results.json\">results.json</a>; means: <a href=\"means.csv\">means.csv</a>.</p>\n",
      finished, results.size(), escape_markup(experiment.graph.filename().string()));
  const std::string of_trials = html_results(experiment, graphs, results, "");
  if (!of_trials.empty())
    page += "<h2>Results</h2>\n" + of_trials + html_meanings(meanings(experiment, graphs, results));
  return page + trial_table(experiment, graphs, results) + html_close();
}

void claim_folder(const std::filesystem::path& folder, const std::filesystem::path& file, bool overwrite) {
  const auto note = folder / "experiment.json";
  const Json owner = {{"experiment", std::filesystem::weakly_canonical(file).string()}};
  if (!overwrite && std::filesystem::exists(folder) && !std::filesystem::is_empty(folder)) {
    std::ifstream in(note);
    const Json noted = Json::parse(in, nullptr, false);
    const bool own = noted == owner;  // also false for what is no JSON
    if (!own)
      throw std::invalid_argument(fmt::format(
          "{}: holds {}; name another folder with -o, or give --overwrite", folder.string(),
          noted.is_object() && noted.contains("experiment") ? "the results of " + text_of(noted["experiment"])
                                                            : "files that no experiment wrote"));
  }
  write_file(note, owner.dump(2) + "\n");
}

void write_results(const Experiment& experiment, const std::vector<Graph>& graphs,
                   const std::vector<TrialResult>& results, const std::filesystem::path& folder) {
  const auto estimates = estimate(experiment, results);
  write_file(folder / "results.csv", tidy_csv(experiment, results));
  write_file(folder / "results.json", tidy_json(experiment, results).dump(1) + "\n");
  write_file(folder / "means.csv", estimates_csv(experiment, estimates));
  for (const auto& plot : plot_estimates(experiment, estimates))
    write_file(folder / "plots" / (plot.title + ".svg"), plot.svg);
  write_file(folder / "experiment.html", experiment_page(experiment, graphs, results));
}

}  // namespace talkgraph
