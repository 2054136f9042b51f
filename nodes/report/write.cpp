#include "nodes/report/write.h"

#include <fmt/format.h>

#include "graph/output_file.h"
#include "nodes/report/page.h"
#include "nodes/write/text.h"

namespace talkgraph {
namespace {

const char* heading(const Collected<Artifact>& clips) {
  std::size_t pictures = 0;
  for (std::size_t i = 0; i < clips.size(); ++i) pictures += is_picture(clips[i].path);
  return pictures == 0 ? "Clips" : pictures == clips.size() ? "Pictures" : "Clips and pictures";
}

}  // namespace

Artifact WriteReport::operator()(const Collected<Table>& tables, const Collected<Plot>& plots,
                                 const Collected<Artifact>& clips, Context& context) const {
  std::string page = html_open(title, notes);
  Json metrics = Json::object();
  if (!tables.empty()) page += "<h2>Scores</h2>\n";
  for (std::size_t i = 0; i < tables.size(); ++i) {
    page += html_table(tables.key(i), tables[i]);
    metrics[tables.key(i)] = Json::parse(to_json(tables[i]));
  }
  if (!plots.empty()) page += "<h2>Plots</h2>\n";
  for (std::size_t i = 0; i < plots.size(); ++i) {
    page += html_plot(plots[i]);
    write_file(context.file("plots/" + plots.key(i) + ".svg"), plots[i].svg);
  }
  if (!clips.empty()) page += fmt::format("<h2>{}</h2>\n<div class=\"clips\">\n", heading(clips));
  for (std::size_t i = 0; i < clips.size(); ++i) page += html_clip(clips.key(i), clips[i]);
  if (!clips.empty()) page += "</div>\n";
  write_file(context.file("metrics.json"), metrics.dump(2) + "\n");
  write_file(context.file("report.html"), page + html_close());
  return {"report.html", title};
}

void describe(Description<WriteReport>& d) {
  d.type("report.write").version(6).summary("writes the report page, the plots and metrics.json").sink();
  d.input("tables", "an object of named tables")
      .input("plots", "an object of named plots")
      .input("clips", "a stream of clips, or pictures");
  d.output("file", "report.html");
  d.param("title", &WriteReport::title).doc("heading of the page");
  d.param("notes", &WriteReport::notes).doc("a paragraph under the heading");
}

}  // namespace talkgraph
