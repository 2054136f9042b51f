#include "study/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "nodes/statistics/intervals.h"
#include "nodes/statistics/proportions.h"

namespace talkgraph::study {
namespace {

using Kind = Comparison::Kind;

void add_row(Table& table, const std::string& name, std::vector<double> cells) {
  table.rows.push_back(name);
  table.cells.push_back(std::move(cells));
}

/// Answers that take clips for what they are not, of all there are.
struct Count {
  std::size_t part = 0, whole = 0;

  void add(bool counts) { part += counts, ++whole; }
  void write(std::vector<double>& cells, double confidence) const {
    const auto [low, high] = wilson_interval(part, whole, confidence);
    const auto n = static_cast<double>(whole);
    cells.insert(cells.end(), {static_cast<double>(part) / n, low, high, n});
  }
};

std::vector<double> of_plays(const Measure& measure, std::size_t bin, bool synthetic, double confidence) {
  std::vector<Score> scores;
  for (const auto& s : measure.scores)
    if (s.clip->synthetic == synthetic && static_cast<std::size_t>(std::clamp(s.plays, 1, 3)) == bin)
      scores.push_back(s);
  const auto means = values_of(means_of(scores));
  const auto [low, high] = student_interval(means, confidence);
  return {mean_of(means), deviation_of(means), low, high, static_cast<double>(scores.size())};
}

/// What a person did with the clips of a test.
struct Use {
  std::map<const Clip*, std::pair<double, int>> clips;  ///< seconds, plays

  double seconds() const {
    double sum = 0;
    for (const auto& [clip, use] : clips) sum += use.first;
    return sum;
  }
  double plays() const {
    double sum = 0;
    for (const auto& [clip, use] : clips) sum += use.second;
    return sum / static_cast<double>(clips.size());
  }
};

std::map<std::int64_t, Use> uses_of(const Findings& findings, const Test& test) {
  std::map<std::int64_t, Use> uses;
  for (const auto& measure : findings.measures) {
    if (measure.test != &test) continue;
    for (const auto& s : measure.scores) {
      auto& [seconds, plays] = uses[s.participant].clips[s.clip];
      seconds = std::max(seconds, s.seconds), plays = std::max(plays, s.plays);
    }
  }
  std::erase_if(uses, [&](const auto& use) { return use.second.clips.size() < clips_shown(test); });
  return uses;
}

void add_times(Table& table, const std::string& name, std::vector<double> minutes, std::vector<double> seconds,
               std::vector<double> plays) {
  for (auto* values : {&minutes, &seconds, &plays}) std::sort(values->begin(), values->end());
  add_row(table, name,
          {quantile_of(minutes, 0.5), quantile_of(minutes, 0.25), quantile_of(minutes, 0.75), quantile_of(seconds, 0.5),
           quantile_of(plays, 0.5), static_cast<double>(minutes.size())});
}

/// The option's number; the last, not to say, also where nothing was said.
std::size_t chosen(const Question& question, const Participant& person) {
  const int option = profile_option(question, person);
  return option < 0 ? question.options.size() - 1 : static_cast<std::size_t>(option);
}

}  // namespace

Table confusions(const Measure& measure, double confidence) {
  std::vector<std::string> speakers;
  std::map<std::string, std::array<Count, 2>> counts;  // of a speaker, synthetic as real and real as synthetic
  std::array<Count, 2> all;
  for (const auto& clip : measure.test->clips)
    if (counts.try_emplace(clip.speaker).second) speakers.push_back(clip.speaker);
  for (const auto& s : measure.scores) {
    const std::size_t side = s.clip->synthetic ? 0 : 1;
    const bool confused = s.option == (s.clip->synthetic ? 0 : 1);
    counts[s.clip->speaker][side].add(confused);
    all[side].add(confused);
  }
  Table table{"Clips taken for what they are not", "speaker", {}, {}, {}};
  for (const std::string name : {"synthetic as real", "real as synthetic"})
    for (const char* what : {"", " low", " high", " answers"}) table.columns.push_back(name + what);
  const auto add = [&](const std::string& name, const std::array<Count, 2>& of) {
    std::vector<double> cells;
    for (const auto& count : of) count.write(cells, confidence);
    add_row(table, name, std::move(cells));
  };
  for (const auto& speaker : speakers) add(speaker, counts[speaker]);
  if (speakers.size() > 1) add("all speakers", all);
  return table;
}

Table table_of(const std::vector<Comparison>& comparisons, const Measure& measure) {
  const Comparison& any = comparisons.front();
  Table table{fmt::format("{}: {} - {}", plain_name(measure.question->id), any.first_name, any.second_name),
              "clips",
              {},
              {},
              {}};
  for (const auto& name : {any.first_name, any.second_name})
    for (const char* what : {"", " std", " people"}) table.columns.push_back(name + what);
  table.columns.emplace_back("difference");
  if (measure.is_share()) table.columns.emplace_back("h");
  for (const char* what : {"U", "p", "p corrected", "effect", "A", "p paired", "p paired corrected"})
    table.columns.emplace_back(what);
  for (const auto& c : comparisons) {
    std::vector<double> cells;
    const auto first = values_of(c.first), second = values_of(c.second);
    for (const auto* side : {&first, &second})
      cells.insert(cells.end(), {mean_of(*side), deviation_of(*side), static_cast<double>(side->size())});
    cells.push_back(c.difference());
    if (measure.is_share()) cells.push_back(cohens_h(mean_of(first), mean_of(second)));
    cells.insert(cells.end(), {std::isnan(c.test.p) ? NAN : c.test.statistic, c.test.p, c.p_corrected, c.test.effect,
                               c.test.superiority(), c.p_paired, c.p_paired_corrected});
    add_row(table, c.of, std::move(cells));
  }
  return table;
}

Table by_plays(const Measure& measure, double confidence) {
  Table table{"By how often a clip was played", "plays", {}, {}, {}};
  for (const std::string name : {"real", "synthetic"})
    for (const char* what : {"", " std", " low", " high", " answers"}) table.columns.push_back(name + what);
  for (std::size_t bin = 1; bin <= 3; ++bin) {
    std::vector<double> cells;
    for (const bool synthetic : {false, true})
      for (const double v : of_plays(measure, bin, synthetic, confidence)) cells.push_back(v);
    add_row(table, bin == 3 ? "3 or more" : std::to_string(bin), std::move(cells));
  }
  return table;
}

Table progress(const Findings& findings) {
  Table table{"Who took part", "people", {"people"}, {}, {}};
  add_row(table, "took part", {static_cast<double>(findings.took_part)});
  add_row(table, "finished", {static_cast<double>(findings.finished)});
  add_row(table, "count here", {static_cast<double>(findings.people.size())});
  return table;
}

std::vector<Table> demographics(const Findings& findings) {
  std::vector<Table> tables;
  const auto& questions = findings.study->profile;
  for (std::size_t q = 0; q < questions.size(); q += 2) {
    const Question& rows = questions[q];
    const Question* columns = q + 1 < questions.size() ? &questions[q + 1] : nullptr;
    Table table{
        plain_name(rows.id) + (columns ? " and " + plain_name(columns->id) : ""), plain_name(rows.id), {}, {}, {}};
    if (columns) table.columns = columns->options;
    table.columns.emplace_back("all");
    for (const auto& option : rows.options) add_row(table, option, std::vector<double>(table.columns.size(), 0));
    add_row(table, "all", std::vector<double>(table.columns.size(), 0));
    for (const auto& person : findings.people)
      for (auto* row : {&table.cells[chosen(rows, person)], &table.cells.back()}) {
        ++row->back();
        if (columns) ++(*row)[chosen(*columns, person)];
      }
    tables.push_back(std::move(table));
  }
  return tables;
}

Table times(const Findings& findings) {
  Table table{
      "Time it took",
      "test",
      {"minutes", "minutes lower quartile", "minutes upper quartile", "seconds a clip", "plays of a clip", "people"},
      {},
      {}};
  for (const auto& test : findings.study->tests) {
    std::vector<double> minutes, seconds, plays;
    for (const auto& [person, use] : uses_of(findings, test)) {
      minutes.push_back(use.seconds() / 60);
      seconds.push_back(use.seconds() / static_cast<double>(use.clips.size()));
      plays.push_back(use.plays());
    }
    add_times(table, test.title, minutes, seconds, plays);
  }
  std::vector<double> minutes;
  for (const auto& person : findings.people)
    if (person.finished > person.started) minutes.push_back(static_cast<double>(person.finished - person.started) / 60);
  add_times(table, "the whole study, with pauses", minutes, {}, {});
  return table;
}

std::vector<std::pair<std::string, Table>> tables_of(const Findings& findings) {
  static const std::map<Kind, std::string> names = {{Kind::clips, "real-synthetic"},
                                                    {Kind::clips_in_groups, "real-synthetic-by-group"},
                                                    {Kind::eyes, "eyes"},
                                                    {Kind::groups, "groups"},
                                                    {Kind::plays, "plays"}};
  std::vector<std::pair<std::string, Table>> tables = {{"people", progress(findings)}};
  for (auto& table : demographics(findings))
    tables.emplace_back(fmt::format("people-{}", tables.size()), std::move(table));
  tables.emplace_back("times", times(findings));
  for (std::size_t m = 0; m < findings.measures.size(); ++m) {
    const Measure& measure = findings.measures[m];
    const std::string of = measure.test->id + "." + measure.question->id + ".";
    if (measure.test->kind == TestKind::turing)
      tables.emplace_back(of + "confusions", confusions(measure, findings.options.confidence));
    tables.emplace_back(of + "by-plays", by_plays(measure, findings.options.confidence));
    std::vector<Comparison> comparisons;
    for (const auto& c : findings.comparisons)
      if (c.measure == m) comparisons.push_back(c);
    std::map<Kind, int> taken;
    for (const auto& together : tabled(comparisons)) {
      const Comparison& any = together.front();
      const int number = ++taken[any.kind];
      tables.emplace_back(of + names.at(any.kind) + (number > 1 ? fmt::format("-{}", number) : ""),
                          table_of(together, measure));
    }
  }
  return tables;
}

}  // namespace talkgraph::study
