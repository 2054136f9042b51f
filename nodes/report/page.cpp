#include "nodes/report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "nodes/plot/svg.h"
#include "nodes/statistics/sequence_scores.h"

namespace talkgraph {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 68rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; }
.wide { overflow-x: auto; }
summary { font-weight: 600; cursor: pointer; margin: 1rem 0; }
details caption { display: none; }
main > .wide, details > .wide { margin-right: min(0px, 50% - 50vw + 1rem); }
table { border-collapse: collapse; margin: 1rem 0 2rem; }
caption { text-align: left; font-weight: 600; padding-bottom: .3rem; }
th, td { padding: .3rem .7rem; border-bottom: 1px solid #ddd; text-align: right; font-variant-numeric: tabular-nums; }
th:first-child { text-align: left; }
td { white-space: nowrap; }
td small { color: #444; }
td.best { font-weight: 700; background: #fdeee0; }
.text, tbody th { text-align: left; white-space: normal; }
tbody th { font-weight: normal; }
tr { background: #fff; }
tbody th.rows { font-weight: 600; padding-top: .8rem; background: #eee; }
tbody th.rows > span { position: sticky; left: .7rem; }
abbr { text-decoration: none; border-bottom: 1px dotted; cursor: help; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1rem; }
dt { font-weight: 600; }
dd { margin: 0; }
nav ul { columns: 24rem; }
tbody tr:hover { background: #f4f4f4; }
tr > :first-child { position: sticky; left: 0; background: inherit; min-width: 12rem; }
tr > :first-child::after { content: ""; position: absolute; inset: 0 0 0 auto; border-right: 1px solid #ddd; }
svg { max-width: 100%; height: auto; }
.clips { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(24rem, 100%), 1fr)); gap: 1rem; }
figure { margin: 0 0 1.5rem; }
video, img { width: 100%; background: #000; }
figcaption { color: #444; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: 1.5rem; padding: 0; list-style: none; }
.figures li { border-top: 3px solid #d55e00; padding-top: .5rem; }
.figures strong { display: block; font-size: 2.2rem; line-height: 1.2; }
.figures small { display: block; color: #555; }
)";

constexpr std::size_t kMostColumns = 20;  ///< of a table that is not folded

/// The column `name`, or -1.
std::ptrdiff_t column_of(const Table& table, const std::string& name) {
  const auto it = std::find(table.columns.begin(), table.columns.end(), name);
  return it == table.columns.end() ? -1 : it - table.columns.begin();
}

/// Whether column c is shown in the cells of another.
bool is_beside_another(const Table& table, std::size_t c) {
  const std::string score = score_beside(table.columns[c]);
  return !score.empty() && column_of(table, score) >= 0;
}

/// Whether a cell "acc: METHOD" has the value of "acc".
bool is_the_best(const Table& table, std::size_t row, std::size_t c) {
  const auto best = column_of(table, table.columns[c].substr(0, table.columns[c].find(": ")));
  return best >= 0 && static_cast<std::size_t>(best) != c &&
         same_score(table.cells[row][c], table.cells[row][static_cast<std::size_t>(best)]);
}

std::string cell(const Table& table, std::size_t row, std::size_t c) {
  const double mean = table.cells[row][c];
  if (std::isnan(mean)) return "<td>–</td>";
  const auto beside = [&](const char* what) {
    const auto column = column_of(table, table.columns[c] + what);
    return column < 0 ? NAN : table.cells[row][static_cast<std::size_t>(column)];
  };
  return (is_the_best(table, row, c) ? "<td class=\"best\">" : "<td>") +
         html_number({mean, beside(" std"), beside(" low"), beside(" high"), beside(" p")}) + "</td>";
}

bool has_significant(const Table& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].ends_with(" p") && is_beside_another(table, c) &&
        std::any_of(table.cells.begin(), table.cells.end(),
                    [&](const auto& cells) { return is_significant(cells[c]); }))
      return true;
  return false;
}

bool is_video(const std::string& path) {
  return path.ends_with(".mp4") || path.ends_with(".webm") || path.ends_with(".mkv");
}

}  // namespace

bool is_picture(const std::string& path) {
  return path.ends_with(".png") || path.ends_with(".jpg") || path.ends_with(".svg");
}

std::string url_of(const std::string& path) {
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 128 && (std::isalnum(byte) || std::string_view("-._~/").find(c) != std::string_view::npos))
      out += c;
    else
      out += fmt::format("%{:02X}", byte);
  }
  return out;
}

std::string html_open(const std::string& title, const std::string& notes) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<main>\n<h1>{0}</h1>\n",
      escape_markup(title), kStyle);
  if (!notes.empty()) page += "<p>" + escape_markup(notes) + "</p>\n";
  return page;
}

std::string html_close() { return "</main>\n</body>\n</html>\n"; }

std::string score_beside(const std::string& column) {
  for (const std::string_view what : {" std", " low", " high", " p"})
    if (column.ends_with(what)) return column.substr(0, column.size() - what.size());
  return "";
}

bool is_significant(double p) { return p < 0.05; }

std::string html_number(const Measured& measured, const std::string& mark) {
  const auto& [mean, deviation, low, high, p] = measured;
  std::string out = std::isnan(deviation) ? fmt::format("{:.4g}", shown_number(mean))
                                          : fmt::format("{:.3g} ± {:.2g}", shown_number(mean), shown_number(deviation));
  out += mark;
  if (is_significant(p)) out = "<strong>" + out + "</strong>";
  if (!std::isnan(low))
    out += fmt::format("<br><small>{:.3g} to {:.3g}</small>", shown_number(low), shown_number(high));
  if (!std::isnan(p)) out += fmt::format("<br><small>p = {:.2g}</small>", p);
  return out;
}

std::string title_with_key(const std::string& title, bool significant) {
  return significant ? title + " (bold: p below 0.05)" : title;
}

std::string html_table(const std::string& name, const Table& table) {
  std::vector<std::size_t> shown;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (!is_beside_another(table, c)) shown.push_back(c);
  const bool folded = shown.size() > kMostColumns;
  const std::string title =
      escape_markup(title_with_key(table.title.empty() ? name : table.title, has_significant(table)));
  std::string out = folded ? "<details><summary>" + title + "</summary>\n" : "";
  out += fmt::format("<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead><tr><th scope=\"col\">{}</th>", title,
                     escape_markup(table.corner));
  for (const std::size_t c : shown) out += "<th scope=\"col\">" + escape_markup(table.columns[c]) + "</th>";
  out += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    out += "<tr><th scope=\"row\">" + escape_markup(table.rows[r]) + "</th>";
    for (const std::size_t c : shown) out += cell(table, r, c);
    out += "</tr>\n";
  }
  return out + "</tbody>\n</table></div>\n" + (folded ? "</details>\n" : "");
}

std::string heading_cell(const std::string& html, std::size_t columns) {
  return fmt::format("<th scope=\"rowgroup\" colspan=\"{}\" class=\"rows\"><span>{}</span></th>", columns, html);
}
std::string number_cell(const std::string& html) { return "<td>" + html + "</td>"; }
std::string text_cell(const std::string& html) { return "<td class=\"text\">" + html + "</td>"; }

std::string html_table(const std::string& caption, const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& lines) {
  std::string out =
      fmt::format("<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead><tr>", escape_markup(caption));
  for (std::size_t c = 0; c < head.size(); ++c) {
    const bool text = std::any_of(lines.begin(), lines.end(), [&](const auto& line) {
      return line.size() == head.size() && line[c].starts_with("<td class");
    });
    out += fmt::format("<th scope=\"col\"{}>{}</th>", text ? " class=\"text\"" : "", head[c]);
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& line : lines) out += fmt::format("<tr>{}</tr>\n", fmt::join(line, ""));
  return out + "</tbody>\n</table></div>\n";
}

std::string html_plot(const Plot& plot) {
  return fmt::format("<figure><figcaption>{}</figcaption>\n<div class=\"wide\">{}</div></figure>\n",
                     escape_markup(plot.title), plot.svg);
}

std::string html_clip(const std::string& name, const Artifact& clip) {
  const std::string label = escape_markup(name);
  const std::string shown =
      is_picture(clip.path) ? fmt::format("<img src=\"{}\" alt=\"{}\">", url_of(clip.path), label)
      : is_video(clip.path)
          ? fmt::format("<video controls preload=\"metadata\" aria-label=\"{1}\" src=\"{0}\"></video>",
                        url_of(clip.path), label)
          : fmt::format("<a href=\"{}\">{}</a>", url_of(clip.path), escape_markup(clip.path));
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", shown, label);
}

}  // namespace talkgraph
