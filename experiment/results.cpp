#include "experiment/results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "nodes/report/page.h"
#include "nodes/statistics/intervals.h"
#include "nodes/types/report.h"
#include "nodes/write/text.h"

namespace talkgraph {
namespace {

/// Calls f(item, value) for a single output, or each item of a stream.
template <class F>
void for_each_value(const RunResult::Output& output, F f) {
  if (!output.stream && output.value) f(std::string(), output.value);
  for (const auto& item : output.items) f(item.key, item.value);
}

void observe_table(const Table& table, const std::string& output, const std::string& item,
                   std::vector<Observation>& out) {
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (!std::isnan(table.cells[r][c]))
        out.push_back({output, item, table.rows[r], table.columns[c], table.cells[r][c]});
}

/// The values of one row and measure of a setting: of each trial, one an item.
using Sample = std::vector<std::vector<double>>;

Estimate estimate_of(const Sample& sample) {
  Estimate out;
  std::vector<double> means;
  for (const auto& trial : sample) means.push_back(mean_of(trial));
  if (means.size() == 1 && sample[0].size() > 1) out.over = Estimate::Over::items;
  const auto& values = out.over == Estimate::Over::items ? sample[0] : means;
  out.n = values.size();
  out.mean = mean_of(values);
  out.deviation = deviation_of(values);
  const auto interval = student_interval(values, 0.95);
  out.low = interval.low, out.high = interval.high;
  return out;
}

const char* over_text(Estimate::Over over) {
  switch (over) {
    case Estimate::Over::repeats:
      return "repeats";
    case Estimate::Over::items:
      return "items";
    case Estimate::Over::table:
      return "table";
  }
  return "";
}

/// Calls f(trial, result, observation) for all that was observed.
template <class F>
void for_each_observation(const Experiment& experiment, const std::vector<TrialResult>& results, F f) {
  for (std::size_t t = 0; t < results.size(); ++t)
    for (const auto& o : results[t].observations) f(experiment.trials[t], results[t], o);
}

/// Setting, output, row, measure.
using Name = std::tuple<std::size_t, std::string, std::string, std::string>;

struct Samples {
  std::map<Name, Sample> all;
  std::vector<Name> names;  ///< in the order in which they came, without what stands beside a measure
};

Samples gather(const Experiment& experiment, const std::vector<TrialResult>& results) {
  Samples out;
  std::map<Name, const Trial*> last;
  std::set<std::pair<std::string, std::string>> measures;
  for_each_observation(experiment, results, [&](const Trial&, const TrialResult&, const Observation& o) {
    measures.insert({o.output, o.measure});
  });
  const auto is_beside = [&](const Observation& o) {
    const std::string score = score_beside(o.measure);
    return !score.empty() && measures.contains({o.output, score});
  };
  for_each_observation(experiment, results, [&](const Trial& trial, const TrialResult&, const Observation& o) {
    const Name name{trial.setting, o.output, o.row, o.measure};
    auto& sample = out.all[name];
    if (sample.empty() && !is_beside(o)) out.names.push_back(name);
    if (sample.empty() || last[name] != &trial) sample.emplace_back();
    last[name] = &trial;
    sample.back().push_back(o.value);
  });
  return out;
}

void take_from_table(Estimate& e, const std::map<Name, Sample>& samples) {
  const auto beside = [&](const char* what) {
    const auto it = samples.find({e.setting, e.output, e.row, e.measure + what});
    return it == samples.end() ? NAN : it->second[0][0];
  };
  e.deviation = beside(" std"), e.low = beside(" low"), e.high = beside(" high"), e.p = beside(" p");
  if (!std::isnan(e.deviation) || !std::isnan(e.low)) e.over = Estimate::Over::table;
}

std::string csv_cell(const Json& cell) { return csv_text(cell.is_string() ? cell.get<std::string>() : cell.dump()); }

std::string csv_line(const std::vector<std::string>& cells) { return fmt::format("{}\n", fmt::join(cells, ",")); }

}  // namespace

const char* status_text(TrialResult::Status status) {
  switch (status) {
    case TrialResult::Status::waiting:
      return "not run";
    case TrialResult::Status::finished:
      return "finished";
    case TrialResult::Status::failed:
      return "failed";
    case TrialResult::Status::stopped:
      return "stopped";
  }
  return "";
}

std::vector<Observation> observe(const Experiment& experiment, const RunResult& run) {
  std::vector<Observation> out;
  for (const auto& name : experiment.tabulate.names)
    for_each_value(run.output(name), [&](const std::string& item, const Value& value) {
      if (value.type().type == port_type<Table>)
        observe_table(value.get<Table>(), name, item, out);
      else
        for (const auto& [measure, v] : value.get<Scores>().values)
          if (!std::isnan(v)) out.push_back({name, item, "", measure, v});
    });
  return out;
}

std::vector<Shown> pick_shown(const Experiment& experiment, const RunResult& run) {
  std::vector<Shown> out;
  for (const auto& name : experiment.show.names)
    for_each_value(run.output(name), [&](const std::string& item, const Value& value) {
      out.push_back({name, item, value});
    });
  return out;
}

std::vector<Estimate> estimate(const Experiment& experiment, const std::vector<TrialResult>& results) {
  const auto [samples, names] = gather(experiment, results);
  std::vector<bool> partial(experiment.settings);
  for (std::size_t t = 0; t < results.size(); ++t)
    if (results[t].failures > 0) partial[experiment.trials[t].setting] = true;
  std::vector<Estimate> out;
  for (const auto& name : names) {
    Estimate& e = out.emplace_back(estimate_of(samples.at(name)));
    std::tie(e.setting, e.output, e.row, e.measure) = name;
    e.partial = partial[e.setting];
    if (e.n == 1) take_from_table(e, samples);
  }
  return out;
}

std::string tidy_csv(const Experiment& experiment, const std::vector<TrialResult>& results) {
  std::vector<std::string> head{"trial"};
  for (const auto& factor : experiment.factors) head.push_back(csv_text(factor));
  for (const char* more : {"seed", "status", "output", "item", "row", "measure", "value"}) head.emplace_back(more);
  std::string out = csv_line(head);
  for_each_observation(experiment, results, [&](const Trial& trial, const TrialResult& result, const Observation& o) {
    std::vector<std::string> line{csv_text(trial.name)};
    for (const auto& level : trial.levels) line.push_back(csv_cell(level));
    line.push_back(trial.seed ? fmt::format("{}", *trial.seed) : "");
    line.emplace_back(status_text(result.status));
    for (const auto* text : {&o.output, &o.item, &o.row, &o.measure}) line.push_back(csv_text(*text));
    line.push_back(fmt::format("{}", o.value));
    out += csv_line(line);
  });
  return out;
}

Json tidy_json(const Experiment& experiment, const std::vector<TrialResult>& results) {
  Json out = Json::array();
  for_each_observation(experiment, results, [&](const Trial& trial, const TrialResult& result, const Observation& o) {
    Json& line = out.emplace_back(Json{{"trial", trial.name}});
    for (std::size_t f = 0; f < experiment.factors.size(); ++f) line[experiment.factors[f]] = trial.levels[f];
    line["seed"] = trial.seed ? Json(*trial.seed) : Json();
    line.update({{"status", status_text(result.status)},
                 {"output", o.output},
                 {"item", o.item},
                 {"row", o.row},
                 {"measure", o.measure}});
    line["value"] = std::isfinite(o.value) ? Json(o.value) : Json();
  });
  return out;
}

std::string estimates_csv(const Experiment& experiment, const std::vector<Estimate>& estimates) {
  std::vector<std::string> head;
  for (const auto& factor : experiment.factors) head.push_back(csv_text(factor));
  for (const char* more : {"output", "row", "measure", "n", "over", "partial", "mean", "std", "low", "high", "p"})
    head.emplace_back(more);
  std::string out = csv_line(head);
  std::vector<const Trial*> of_setting(experiment.settings);
  for (const auto& trial : experiment.trials) of_setting[trial.setting] = &trial;
  for (const auto& e : estimates) {
    std::vector<std::string> line;
    for (const auto& level : of_setting[e.setting]->levels) line.push_back(csv_cell(level));
    for (const auto* text : {&e.output, &e.row, &e.measure}) line.push_back(csv_text(*text));
    line.push_back(fmt::format("{}", e.n));
    line.emplace_back(over_text(e.over));
    line.emplace_back(e.partial ? "yes" : "no");
    for (const double v : {e.mean, e.deviation, e.low, e.high, e.p})
      line.push_back(std::isnan(v) ? "" : fmt::format("{}", v));
    out += csv_line(line);
  }
  return out;
}

}  // namespace talkgraph
