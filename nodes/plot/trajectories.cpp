#include "nodes/plot/trajectories.h"

#include "nodes/plot/svg.h"

namespace talkgraph {
namespace {

Series mean_line(const std::string& name, const Track& track) {
  Series s;
  s.name = name;
  for (Eigen::Index t = 0; t < track.frames() && track.dimension() > 0; ++t) {
    s.x.push_back(track.time(t));
    s.y.push_back(track.values.row(t).mean());
  }
  return s;
}

}  // namespace

Plot PlotTrajectories::operator()(const Collected<Track>& truth, const Collected<Track>& predicted) const {
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < truth.size() && static_cast<int>(panels.size()) < sequences; ++i) {
    const Track* p = predicted.find(truth.key(i));
    if (!p) continue;
    panels.push_back({truth.key(i), "time, s", "mean", {mean_line("truth", truth[i]), mean_line("prediction", *p)}});
  }
  return {title, draw_panels(title, panels, {1, 720, 200})};
}

void describe(Description<PlotTrajectories>& d) {
  d.type("plot.trajectories").summary("tracks averaged over their dimensions, truth against prediction over time");
  d.source("Thesis §6.2.3, Eqns 6.10 and 6.11, Figures 6.1 to 6.4");
  d.input("truth", "recorded sequences")
      .input("predicted", "synthesised ones, by the same keys")
      .output("plot", "a panel a sequence");
  d.param("sequences", &PlotTrajectories::sequences).within(1, 30).doc("how many are shown, from the first");
  d.param("title", &PlotTrajectories::title).doc("heading");
}

}  // namespace talkgraph
