#include "study/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/plot/dots.h"
#include "nodes/plot/svg.h"
#include "nodes/report/page.h"
#include "nodes/statistics/intervals.h"
#include "nodes/statistics/proportions.h"
#include "study/story.h"
#include "study/tables.h"

namespace talkgraph::study {
namespace {

using Kind = Comparison::Kind;
const std::vector<std::string> kSides = {"real", "synthetic"};

std::vector<Comparison> comparisons_of(const Findings& findings, const Test& test, Kind kind) {
  std::vector<Comparison> of;
  for (const auto& c : findings.comparisons)
    if (findings.measures[c.measure].test == &test && c.kind == kind) of.push_back(c);
  return of;
}

bool is_answered(const Findings& findings, const Test& test) {
  return std::any_of(findings.measures.begin(), findings.measures.end(),
                     [&](const Measure& m) { return m.test == &test && !m.scores.empty(); });
}

// Plots

/// Shares as per cent, within what there can be.
Dot dot_of(const Measure& measure, double value, double low, double high) {
  const double unit = measure.is_share() ? 100 : 1, least = measure.is_share() ? 0 : 1;
  return {unit * value, unit * std::max(low, least), unit * std::min(high, measure.most())};
}

Dot dot_of(const Measure& measure, const Means& means, double confidence) {
  const auto values = values_of(means);
  const auto [low, high] = student_interval(values, confidence);
  return dot_of(measure, mean_of(values), low, high);
}

DotPanel panel_of(const Measure& measure, const std::string& title) {
  if (measure.is_share()) return {title, "%", 0, 100, 100 * measure.chance(), 1, {}};
  return {title, fmt::format("mean opinion, 1 to {:.0f}", measure.most()), 1, measure.most(), NAN, 2, {}};
}

/// A dot for either side of each comparison.
DotPanel compared_panel(const Findings& findings, const Measure& measure, Kind kind, const std::string& title) {
  DotPanel panel = panel_of(measure, title);
  for (const auto& c : comparisons_of(findings, *measure.test, kind))
    if (&findings.measures[c.measure] == &measure)
      panel.rows.push_back({c.of,
                            {dot_of(measure, c.first, findings.options.confidence),
                             dot_of(measure, c.second, findings.options.confidence)}});
  return panel;
}

DotPanel confusion_panel(const Findings& findings, const Measure& measure) {
  DotPanel panel = panel_of(measure, "taken for what they are not");
  panel.x_label = "% of answers";
  const Table table = confusions(measure, findings.options.confidence);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& cells = table.cells[r];
    panel.rows.push_back(
        {table.rows[r],
         {dot_of(measure, cells[4], cells[5], cells[6]), dot_of(measure, cells[0], cells[1], cells[2])}});
  }
  return panel;
}

DotPanel replay_panel(const Findings& findings, const Measure& measure) {
  DotPanel panel = panel_of(measure, measure_text(measure));
  const Table table = by_plays(measure, findings.options.confidence);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& cells = table.cells[r];
    panel.rows.push_back(
        {r == 0 ? "1 play" : table.rows[r] + " plays",
         {dot_of(measure, cells[0], cells[2], cells[3]), dot_of(measure, cells[5], cells[7], cells[8])}});
  }
  return panel;
}

Plot test_plot(const Findings& findings, const Test& test) {
  std::vector<DotPanel> panels;
  for (const auto& measure : findings.measures) {
    if (measure.test != &test) continue;
    if (test.kind == TestKind::turing)
      panels.push_back(confusion_panel(findings, measure));
    else
      panels.push_back(compared_panel(findings, measure, Kind::clips, measure_text(measure)));
    if (!comparisons_of(findings, test, Kind::clips_in_groups).empty())
      panels.push_back(compared_panel(findings, measure, Kind::clips_in_groups, measure_text(measure) + ", by group"));
  }
  const std::string whiskers = fmt::format("whiskers: {:.0f} % intervals", 100 * findings.options.confidence);
  const bool guessed = test.kind != TestKind::perceptual;
  return {fmt::format("{}; {}{}", test.kind == TestKind::turing ? "Shares of answers" : "Means over people", whiskers,
                      guessed ? "; dashed: chance" : ""),
          draw_dots(test.title, kSides, panels, 3)};
}

Plot replay_plot(const Findings& findings) {
  std::vector<DotPanel> panels;
  for (const auto& measure : findings.measures)
    if (!measure.scores.empty()) panels.push_back(replay_panel(findings, measure));
  return {fmt::format("Means over people, by how often a clip was played; whiskers: {:.0f} % intervals",
                      100 * findings.options.confidence),
          draw_dots("By how often a clip was played", kSides, panels, 3)};
}

// Tables

std::string spread_text(const Means& means, const Measure& measure) {
  const auto values = values_of(means);
  std::string text = score_text(mean_of(values), measure);
  if (const double spread = deviation_of(values); !std::isnan(spread)) text += " ± " + score_text(spread, measure);
  return text;
}

/// With the sign that print has.
std::string signed_text(double v, int digits) {
  if (std::isnan(v)) return "–";
  const std::string size = fmt::format("{:.{}f}", std::abs(v), digits);
  const bool zero = size.find_first_not_of("0.") == std::string::npos;
  return (zero ? "" : v < 0 ? "−" : "+") + size;
}

std::string number_text(double v, int digits) { return std::isnan(v) ? "–" : fmt::format("{:.{}f}", v, digits); }

std::string exact_text(double p) {
  return std::isnan(p) ? "–" : p < 0.0001 ? fmt::format("{:.1e}", p) : fmt::format("{:.4f}", p);
}

std::vector<std::string> comparison_line(const Findings& findings, const Comparison& c, const Measure& measure) {
  const std::string corrected = exact_text(c.p_corrected);
  const bool shares = measure.is_share();
  std::vector<std::string> line = {
      text_cell(escape_markup(c.of)), number_cell(spread_text(c.first, measure)),
      number_cell(spread_text(c.second, measure)),
      number_cell(shares ? signed_text(100 * c.difference(), 0) : signed_text(c.difference(), 2))};
  if (shares)
    line.push_back(number_cell(signed_text(cohens_h(mean_of(values_of(c.first)), mean_of(values_of(c.second))), 2)));
  line.insert(line.end(), {number_cell(signed_text(c.test.effect, 2)), number_cell(escape_markup(p_text(c.test.p))),
                           number_cell(exact_text(c.test.p)),
                           number_cell(findings.differs(c) ? "<strong>" + corrected + "</strong>" : corrected),
                           number_cell(exact_text(c.p_paired_corrected))});
  return line;
}

/// Comparisons of all measures of a test by the same sides.
std::string comparison_table(const Findings& findings, const std::vector<Comparison>& comparisons) {
  const Comparison& any = comparisons.front();
  const Measure& of = findings.measures[any.measure];
  std::vector<std::string> head = {"clips", escape_markup(any.first_name), escape_markup(any.second_name),
                                   of.is_share() ? "points" : "difference"};
  if (of.is_share()) head.emplace_back("h");
  head.insert(head.end(), {"r", "p", "p-value", "corrected", "paired"});
  const bool several = comparisons.back().measure != any.measure;
  std::vector<std::vector<std::string>> lines;
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const Measure& measure = findings.measures[comparisons[i].measure];
    if (several && (i == 0 || comparisons[i].measure != comparisons[i - 1].measure))
      lines.push_back({heading_cell(escape_markup(measure_text(measure)), head.size())});
    lines.push_back(comparison_line(findings, comparisons[i], measure));
  }
  std::string caption = fmt::format("{} against {}", any.first_name, any.second_name);
  if (any.kind == Kind::clips_in_groups) caption += ", group by group";
  if (!several) caption = measure_text(of) + " – " + caption;
  return html_table(capital(caption), head, lines);
}

std::string comparison_tables(const Findings& findings, const Test& test, Kind kind) {
  std::string html;
  for (const auto& table : tabled(comparisons_of(findings, test, kind))) html += comparison_table(findings, table);
  return html;
}

std::string confusion_table(const Table& table) {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& cells = table.cells[r];
    auto& line = lines.emplace_back(1, text_cell(escape_markup(table.rows[r])));
    for (const std::size_t at : {0, 4})
      line.push_back(number_cell(
          cells[at + 3] == 0 ? "–"
                             : fmt::format("{:.1f} %<br><small>{:.1f} to {:.1f} %, of {:.0f} answers</small>",
                                           100 * cells[at], 100 * cells[at + 1], 100 * cells[at + 2], cells[at + 3])));
  }
  return html_table(table.title, {escape_markup(table.corner), "synthetic taken for real", "real taken for synthetic"},
                    lines);
}

/// Numbers of people with their share of all.
std::string people_table(const Table& table, std::size_t people) {
  std::vector<std::string> head = {escape_markup(table.corner)};
  for (const auto& column : table.columns) head.push_back(escape_markup(column));
  std::vector<std::vector<std::string>> lines;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    auto& line = lines.emplace_back(1, text_cell(escape_markup(table.rows[r])));
    for (const double n : table.cells[r])
      line.push_back(number_cell(
          n == 0 ? "0" : fmt::format("{:.0f} <small>({:.0f} %)</small>", n, 100 * n / static_cast<double>(people))));
  }
  return html_table(capital(table.title), head, lines);
}

std::string time_table(const Table& table) {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& cells = table.cells[r];
    const std::string minutes =
        std::isnan(cells[0]) ? "–"
                             : fmt::format("{:.1f}<br><small>{:.1f} to {:.1f}</small>", cells[0], cells[1], cells[2]);
    lines.push_back({text_cell(escape_markup(table.rows[r])), number_cell(minutes),
                     number_cell(number_text(cells[3], 1)), number_cell(number_text(cells[4], 1)),
                     number_cell(number_text(cells[5], 0))});
  }
  return html_table(table.title + ": medians, and the middle half of people",
                    {"test", "minutes", "seconds a clip", "plays of a clip", "people who finished it"}, lines);
}

// Sections

std::string paragraph(const std::string& text) { return "<p>" + escape_markup(text) + "</p>\n"; }

std::string found(const Findings& findings) {
  std::string html = "<h2>What was found</h2>\n";
  const auto figures = headlines(findings);
  if (!figures.empty()) html += "<ul class=\"figures\">\n";
  for (const auto& h : figures)
    html += fmt::format("<li><strong>{}</strong>{}<small>{}</small></li>\n", escape_markup(h.figure),
                        escape_markup(h.text), escape_markup(h.beside));
  if (!figures.empty()) html += "</ul>\n";
  if (findings.people.empty()) return html + paragraph("There are no answers to tell of yet.");
  for (const auto& chapter : story(findings)) {
    html += fmt::format("<h3>{}</h3>\n<ul>\n", escape_markup(chapter.title));
    for (const auto& sentence : chapter.sentences) html += "<li>" + escape_markup(sentence) + "</li>\n";
    html += "</ul>\n";
  }
  return html;
}

std::string test_section(const Findings& findings, const Test& test) {
  std::string html = fmt::format("<h2>{}</h2>\n", escape_markup(test.title));
  if (!is_answered(findings, test)) return html + paragraph("It was not answered yet.");
  for (const auto& measure : findings.measures)
    if (measure.test == &test && !measure.question->text.empty())
      html += paragraph(fmt::format("{}: “{}”", plain_name(measure.question->id), measure.question->text));
  html += html_plot(test_plot(findings, test));
  for (const auto& measure : findings.measures)
    if (measure.test == &test && test.kind == TestKind::turing)
      html += confusion_table(confusions(measure, findings.options.confidence));
  for (const Kind kind : {Kind::clips, Kind::eyes, Kind::clips_in_groups, Kind::groups})
    html += comparison_tables(findings, test, kind);
  return html;
}

std::string replay_section(const Findings& findings) {
  std::string html = "<h2>Replays</h2>\n" + html_plot(replay_plot(findings));
  for (const auto& test : findings.study->tests)
    if (is_answered(findings, test)) html += comparison_tables(findings, test, Kind::plays);
  return html;
}

std::string people_section(const Findings& findings) {
  std::string html = "<h2>Who took part</h2>\n";
  for (const auto& table : demographics(findings)) html += people_table(table, findings.people.size());
  return html + time_table(times(findings));
}

std::string correction_text(Correction correction) {
  switch (correction) {
    case Correction::holm:
      return "by Holm, which bounds the chance of a single false finding";
    case Correction::benjamini_hochberg:
      return "by Benjamini and Hochberg, which bounds the share of false findings";
    default:
      return "not at all: as many as are made, some will differ by chance";
  }
}

std::string method_section(const Findings& findings) {
  std::string html = "<h2>How it was computed</h2>\n";
  html += paragraph(fmt::format(
      "A person's score is the mean of that person's answers of a kind: the share taken for real, the share "
      "read right, or the mean opinion. After ± stands the standard deviation over people. Whiskers are "
      "{:.0f} % intervals of the mean over people (Student's t); those of clips taken for what they are not "
      "are Wilson's, which take every answer as independent.",
      100 * findings.options.confidence));
  html += paragraph(fmt::format(
      "p is of Wilcoxon's rank-sum test of people's scores, two-sided: exact for up to 50 scores, ties "
      "included, else of the tie-corrected normal approximation with continuity correction. It is said to be "
      "below 0.001, 0.01 or 0.05, or above the largest hundredth that it exceeds. The test takes both sides "
      "as independent; where the same people gave both, the signed-rank test pairs them, and finds more: its "
      "p, corrected, stands under “paired”. p-values are corrected {}, over all comparisons of one sort "
      "within a test of the study; bold ones are below {:.2f}. What does not differ was not shown to be equal.",
      correction_text(findings.options.correction), 1 - findings.options.confidence));
  html += paragraph(
      "Points are differences of percentages. h is Cohen's effect size of mean shares: 0.2 is small, 0.5 medium, 0.8 "
      "large. r is the rank-biserial correlation, from −1 to 1; (1 + r)/2, Vargha and Delaney's A, is how likely a "
      "person's score on the first side is above one on the second.");
  return html;
}

}  // namespace

std::vector<std::pair<std::string, Plot>> plots_of(const Findings& findings) {
  std::vector<std::pair<std::string, Plot>> plots;
  for (const auto& test : findings.study->tests)
    if (is_answered(findings, test)) plots.emplace_back(test.id, test_plot(findings, test));
  if (!plots.empty()) plots.emplace_back("study.replays", replay_plot(findings));
  return plots;
}

std::string report_page(const Findings& findings, const Answers& answers) {
  std::string page = html_open(findings.study->title, about_people(findings, answers)) + found(findings);
  const bool answered = !findings.people.empty();
  for (const auto& test : findings.study->tests)
    if (answered) page += test_section(findings, test);
  if (answered) page += replay_section(findings);
  if (answered) page += people_section(findings) + method_section(findings);
  page +=
      "<p>All numbers: <a href=\"summary.csv\">summary.csv</a>, <a href=\"summary.json\">summary.json</a>; "
      "every answer: <a href=\"answers.csv\">answers.csv</a>, <a href=\"answers.json\">answers.json</a>.</p>\n";
  return page + html_close();
}

}  // namespace talkgraph::study
