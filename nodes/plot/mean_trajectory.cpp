#include "nodes/plot/mean_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "nodes/plot/svg.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

constexpr int points = 21;

/// Sums of stretched trajectories of one phone.
struct Average {
  int count = 0;
  Eigen::ArrayXd truth = Eigen::ArrayXd::Zero(points), predicted = Eigen::ArrayXd::Zero(points);
};

/// Frames from..to read at evenly spaced places, linearly between frames.
Eigen::ArrayXd stretched(const Eigen::VectorXd& x, double from, double to) {
  Eigen::ArrayXd out(points);
  for (int i = 0; i < points; ++i) {
    const double at = std::clamp(from + (to - from) * i / (points - 1), 0.0, static_cast<double>(x.size() - 1));
    const auto below = static_cast<Eigen::Index>(at);
    const auto above = std::min<Eigen::Index>(below + 1, x.size() - 1);
    out[i] = x[below] + (at - static_cast<double>(below)) * (x[above] - x[below]);
  }
  return out;
}

}  // namespace

Plot MeanTrajectory::operator()(const Collected<Track>& truth, const Collected<Track>& predicted,
                                const Collected<FrameLabels>& labels) const {
  std::map<std::string, Average> averages;
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
    const Eigen::VectorXd z = truth[i].values.col(dimension), q = p->values.col(dimension);
    for (std::size_t start = 0, end = 0; start < l->labels.size(); start = end) {
      while (end < l->labels.size() && l->labels[end] == l->labels[start]) ++end;
      if (is_pause(l->labels[start])) continue;
      auto& average = averages[l->labels[start]];
      const double from = static_cast<double>(start) - margin, to = static_cast<double>(end) - 1 + margin;
      ++average.count;
      average.truth += stretched(z, from, to);
      average.predicted += stretched(q, from, to);
    }
  }
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [phone, average] : averages) order.emplace_back(-average.count, phone);
  std::sort(order.begin(), order.end());
  order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(phones)));

  std::vector<Panel> panels;
  std::vector<double> x(points);
  for (int i = 0; i < points; ++i) x[static_cast<std::size_t>(i)] = static_cast<double>(i) / (points - 1);
  for (const auto& [count, phone] : order) {
    const auto& average = averages[phone];
    const auto line = [&](const Eigen::ArrayXd& sum) {
      const Eigen::ArrayXd mean = sum / average.count;
      return std::vector<double>(mean.begin(), mean.end());
    };
    panels.push_back({phone + " (" + std::to_string(average.count) + ")",
                      "time within the phone and its margin",
                      "parameter " + std::to_string(dimension + 1),
                      {{"truth", x, line(average.truth)}, {"prediction", x, line(average.predicted)}}});
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
