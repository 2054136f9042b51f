#include "nodes/plot/tracks.h"

#include <algorithm>

#include "nodes/plot/svg.h"

namespace talkgraph {
namespace {

Series line(const std::string& name, const Track& track, Eigen::Index d) {
  Series s;
  s.name = name;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    s.x.push_back(track.time(t));
    s.y.push_back(track.values(t, d));
  }
  return s;
}

}  // namespace

Plot PlotTracks::operator()(const Track& truth, const Track& predicted, Context& context) const {
  std::vector<Panel> panels;
  const auto most = std::min<Eigen::Index>({dimensions, truth.dimension(), predicted.dimension()});
  for (Eigen::Index d = 0; d < most; ++d)
    panels.push_back({"parameter " + std::to_string(d + 1),
                      d + 1 == most ? "time, s" : "",
                      "",
                      {line("truth", truth, d), line("prediction", predicted, d)}});
  const std::string title = context.item.empty() ? "truth and prediction" : context.item;
  return {title, draw_panels(title, panels, {1, 720, 200})};
}

void describe(Description<PlotTracks>& d) {
  d.type("plot.tracks").summary("the first dimensions of two tracks over time");
  d.input("truth", "recorded").input("predicted", "synthesised").output("plot", "a panel a dimension");
  d.param("dimensions", &PlotTracks::dimensions).within(1, 30).doc("how many are shown");
}

}  // namespace talkgraph
