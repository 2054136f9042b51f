#include "nodes/plot/trajectories.h"

#include <algorithm>

#include "nodes/plot/svg.h"

namespace talkgraph {
namespace {

const Track* find(const Curves& curves, const std::string& key) {
  const auto it = std::find(curves.keys.begin(), curves.keys.end(), key);
  return it == curves.keys.end() ? nullptr : &curves.curves[static_cast<std::size_t>(it - curves.keys.begin())];
}

Series line(const std::string& name, const Track& curve) {
  Series s{name, {}, {}};
  for (Eigen::Index t = 0; t < curve.frames(); ++t) {
    s.x.push_back(curve.time(t));
    s.y.push_back(curve.values(t, 0));
  }
  return s;
}

}  // namespace

Plot PlotTrajectories::operator()(const Collected<Curves>& curves) const {
  std::vector<Panel> panels;
  for (const auto& key : curves.empty() ? std::vector<std::string>{} : curves[0].keys) {
    Panel panel{key, "time, s", y_label, {}};
    for (std::size_t i = 0; i < curves.size(); ++i)
      if (const Track* curve = find(curves[i], key)) panel.series.push_back(line(curves.key(i), *curve));
    if (panel.series.size() == curves.size() && std::ssize(panels) < sequences) panels.push_back(std::move(panel));
  }
  return {title, draw_panels(title, panels, {1, 720, 200})};
}

void describe(Description<PlotTrajectories>& d) {
  d.type("plot.trajectories").version(2).summary("curves of sequences over time, those of all methods together");
  d.source("Thesis §6.2.3, Figures 6.1 to 6.4");
  d.input("curves", "of the recording and of methods, by their names")
      .output("plot", "a panel a sequence that all have");
  d.param("sequences", &PlotTrajectories::sequences).within(1, 30).doc("how many are shown, from the first");
  d.param("y_label", &PlotTrajectories::y_label).doc("under which the curves stand");
  d.param("title", &PlotTrajectories::title).doc("heading");
}

}  // namespace talkgraph
