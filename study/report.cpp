#include "study/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "graph/json.h"
#include "graph/output_file.h"
#include "nodes/write/text.h"
#include "study/messages.h"
#include "study/report_page.h"
#include "study/session.h"
#include "study/story.h"
#include "study/tables.h"

namespace talkgraph::study {
namespace {

const std::string& option_text(const std::vector<std::string>& options, int option) {
  static const std::string none;
  return option >= 0 && option < static_cast<int>(options.size()) ? options[static_cast<std::size_t>(option)] : none;
}

std::string line(const std::vector<std::string>& cells) {
  std::vector<std::string> quoted;
  for (const auto& cell : cells) quoted.push_back(csv_text(cell));
  return fmt::format("{}\n", fmt::join(quoted, ","));
}

/// A line an answer, with what the clip shows, the score and who gave it.
std::string answers_csv(const Study& study, const Answers& answers) {
  std::vector<std::string> head = {"participant", "finished", "test",    "question", "clip",   "speaker",
                                   "sequence",    "shown",    "eyes",    "option",   "answer", "score",
                                   "position",    "plays",    "seconds", "given"};
  for (const auto& question : study.profile) head.push_back(question.id);
  std::map<std::int64_t, const Participant*> people;
  for (const auto& person : answers.participants) people[person.id] = &person;
  std::string csv = line(head);
  for (const auto& answer : answers.answers) {
    const Score score = score_of(study, answer);
    const Participant& person = *people.at(answer.participant);
    const Clip& clip = *score.clip;
    std::vector<std::string> cells = {std::to_string(person.id),
                                      person.finished ? "yes" : "no",
                                      answer.test,
                                      answer.question,
                                      clip.id,
                                      clip.speaker,
                                      clip.sequence,
                                      clip.synthetic ? "synthetic" : "real",
                                      clip.eyes,
                                      std::to_string(answer.option),
                                      option_text(options(*score.question, clip), answer.option),
                                      fmt::format("{}", score.value),
                                      std::to_string(answer.position),
                                      std::to_string(answer.plays),
                                      fmt::format("{}", answer.seconds),
                                      std::to_string(answer.given)};
    for (const auto& question : study.profile) {
      const auto chosen = person.profile.find(question.id);
      cells.push_back(chosen == person.profile.end() ? "" : option_text(question.options, chosen->second));
    }
    csv += line(cells);
  }
  return csv;
}

using Tables = std::vector<std::pair<std::string, Table>>;

/// A line a number.
std::string summary_csv(const Tables& tables) {
  std::string csv = line({"table", "row", "column", "value"});
  for (const auto& [name, table] : tables)
    for (std::size_t r = 0; r < table.rows.size(); ++r)
      for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const double v = table.cells[r][c];
        csv += line({name, table.rows[r], table.columns[c], std::isfinite(v) ? fmt::format("{}", v) : ""});
      }
  return csv;
}

Json table_json(const Table& table) {
  Json rows = Json::array();
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    Json values = Json::array();
    for (const double v : table.cells[r]) values.push_back(std::isfinite(v) ? Json(v) : Json());
    rows.push_back({{"name", table.rows[r]}, {"values", values}});
  }
  return {{"title", table.title}, {"columns", table.columns}, {"rows", rows}};
}

std::string_view name_of(Correction correction) {
  for (const auto& entry : enum_names<Correction>.entries)
    if (entry.value == correction) return entry.name;
  return {};
}

Json story_json(const Findings& findings) {
  Json chapters = Json::array();
  for (const auto& chapter : story(findings))
    chapters.push_back({{"test", chapter.title}, {"found", chapter.sentences}});
  return chapters;
}

Json summary_json(const Findings& findings, const Tables& tables) {
  Json of_tables = Json::object();
  for (const auto& [name, table] : tables) of_tables[name] = table_json(table);
  return {{"study", findings.study->title},
          {"finished_only", findings.options.finished_only},
          {"correction", name_of(findings.options.correction)},
          {"confidence", findings.options.confidence},
          {"story", story_json(findings)},
          {"tables", of_tables}};
}

}  // namespace

void write_report(const Study& study, const Answers& answers, const FindingOptions& options,
                  const std::filesystem::path& folder) {
  const Findings findings = find(study, answers, options);
  const Tables tables = tables_of(findings);
  write_file(folder / "answers.csv", answers_csv(study, answers));
  write_file(folder / "answers.json", to_json(answers).dump(1) + "\n");
  write_file(folder / "summary.csv", summary_csv(tables));
  write_file(folder / "summary.json", summary_json(findings, tables).dump(1) + "\n");
  for (const auto& [name, plot] : plots_of(findings)) write_file(folder / "plots" / (name + ".svg"), plot.svg);
  write_file(folder / "report.html", report_page(findings, answers));
}

}  // namespace talkgraph::study
