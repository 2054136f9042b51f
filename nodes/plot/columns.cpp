#include "nodes/plot/columns.h"

#include "nodes/plot/svg.h"

namespace talkgraph {

Plot PlotColumns::operator()(const Track& track, Context& context) const {
  Panel panel{context.item.empty() ? title : title + ", " + context.item, "time, s", "", {}};
  for (Eigen::Index d = 0; d < track.dimension(); ++d) {
    Series line{column_name(track, d), {}, {}};
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      line.x.push_back(track.time(t));
      line.y.push_back(track.values(t, d));
    }
    panel.series.push_back(std::move(line));
  }
  return {panel.title, draw_panels(panel.title, {panel}, {1, 760, 260})};
}

std::string column_name(const Track& track, Eigen::Index d) {
  return track.names.empty() ? std::to_string(d + 1) : track.names[static_cast<std::size_t>(d)];
}

void describe(Description<PlotColumns>& d) {
  d.type("plot.columns").summary("the dimensions of a track over time, a line each");
  d.source("Thesis Figures 3.9 to 3.16");
  d.input("track", "with few dimensions").output("plot", "one panel");
  d.param("title", &PlotColumns::title).doc("heading");
}

}  // namespace talkgraph
