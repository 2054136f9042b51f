#include "nodes/report/write.h"

#include <fmt/format.h>

#include <cmath>

#include "nodes/plot/svg.h"
#include "nodes/report/files.h"

namespace talkgraph {
namespace {

constexpr const char* style = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 68rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; }
table { border-collapse: collapse; margin: 1rem 0; }
th, td { padding: .3rem .7rem; border-bottom: 1px solid #ddd; text-align: right; font-variant-numeric: tabular-nums; }
th:first-child { text-align: left; }
svg { max-width: 100%; height: auto; }
.clips { display: grid; grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); gap: 1rem; }
figure { margin: 0; }
video { width: 100%; background: #000; }
figcaption { font-size: .9rem; color: #555; }
)";

std::string html_table(const std::string& name, const Table& table) {
  std::string out = fmt::format("<h2>{}</h2>\n<div style=\"overflow-x: auto\"><table>\n<tr><th scope=\"col\">{}</th>",
                                escape_markup(table.title.empty() ? name : table.title), escape_markup(table.corner));
  for (const auto& column : table.columns) out += "<th scope=\"col\">" + escape_markup(column) + "</th>";
  out += "</tr>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    out += "<tr><th scope=\"row\">" + escape_markup(table.rows[r]) + "</th>";
    for (const double v : table.cells[r]) out += std::isnan(v) ? "<td>–</td>" : fmt::format("<td>{:.4g}</td>", v);
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string html_clip(const std::string& name, const Artifact& clip) {
  return fmt::format(
      "<figure><video controls preload=\"metadata\" src=\"{}\"></video><figcaption>{}</figcaption></figure>\n",
      escape_markup(clip.path), escape_markup(name));
}

}  // namespace

Artifact WriteReport::operator()(const Collected<Table>& tables, const Collected<Plot>& plots,
                                 const Collected<Artifact>& clips, Context& context) const {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\"><title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n",
      escape_markup(title), style);
  if (!notes.empty()) page += "<p>" + escape_markup(notes) + "</p>\n";
  Json metrics = Json::object();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    page += html_table(tables.key(i), tables[i]);
    metrics[tables.key(i)] = Json::parse(to_json(tables[i]));
  }
  for (std::size_t i = 0; i < plots.size(); ++i) {
    page += fmt::format("<h2>{}</h2>\n<figure>{}</figure>\n", escape_markup(plots[i].title), plots[i].svg);
    write_whole(context.folder / "plots" / (plots.key(i) + ".svg"), plots[i].svg);
  }
  if (!clips.empty()) page += "<h2>Clips</h2>\n<div class=\"clips\">\n";
  for (std::size_t i = 0; i < clips.size(); ++i) page += html_clip(clips.key(i), clips[i]);
  if (!clips.empty()) page += "</div>\n";
  write_whole(context.folder / "metrics.json", metrics.dump(2));
  write_whole(context.folder / "report.html", page + "</body>\n</html>\n");
  return {"report.html", "report"};
}

void describe(Description<WriteReport>& d) {
  d.type("report.write").summary("writes the report page, the plots and metrics.json").sink();
  d.input("tables", "an object of named tables")
      .input("plots", "an object of named plots")
      .input("clips", "a stream of clips");
  d.output("file");
  d.param("title", &WriteReport::title).doc("heading of the page");
  d.param("notes", &WriteReport::notes).doc("a paragraph under the heading");
}

}  // namespace talkgraph
