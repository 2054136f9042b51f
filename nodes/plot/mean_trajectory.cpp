#include "nodes/plot/mean_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "nodes/plot/phone_averages.h"

namespace talkgraph {

Plot MeanTrajectory::operator()(const Collected<Track>& truth, const Collected<Track>& predicted,
                                const Collected<FrameLabels>& labels) const {
  PhoneAverages averages(margin);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Track* p = predicted.find(truth.key(i));
    const FrameLabels* l = labels.find(truth.key(i));
    if (!p || !l || truth[i].frames() == 0 || p->frames() == 0) continue;
    if (dimension >= truth[i].dimension() || dimension >= p->dimension())
      return {title + fmt::format(": the tracks have no parameter {}", dimension + 1), draw_panels(title, {})};
    const auto labelled = static_cast<Eigen::Index>(l->labels.size());
    const auto [shortest, longest] = std::minmax({labelled, truth[i].frames(), p->frames()});
    if (longest - shortest > 2)
      throw std::runtime_error(truth.key(i) + ": " + std::to_string(truth[i].frames()) + " frames of truth, " +
                               std::to_string(p->frames()) + " of prediction and " + std::to_string(labelled) +
                               " labels");
    averages.add(*l, {truth[i].values.col(dimension), p->values.col(dimension)});
  }
  std::vector<Panel> panels;
  for (const auto& phone : averages.most_frequent(phones)) {
    panels.push_back(averages.panel(phone, {"truth", "prediction"}, false));
    panels.back().y_label = "parameter " + std::to_string(dimension + 1);
  }
  return {title, draw_panels(title, panels)};
}

void describe(Description<MeanTrajectory>& d) {
  d.type("plot.mean_trajectory").summary("mean trajectories through phones, truth against prediction");
  d.input("truth", "recorded sequences")
      .input("predicted", "synthesised ones, by the same keys")
      .input("labels", "phones at the video rate")
      .output("plot", "a panel a phone");
  d.param("dimension", &MeanTrajectory::dimension).at_least(0).doc("of the tracks, from 0");
  d.param("phones", &MeanTrajectory::phones).within(1, 60).doc("most frequent phones shown");
  d.param("margin", &MeanTrajectory::margin).within(0, 50).unit("frames").doc("before and after each phone");
  d.param("title", &MeanTrajectory::title).doc("heading");
}

}  // namespace talkgraph
