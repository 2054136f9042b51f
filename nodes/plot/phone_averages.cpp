#include "nodes/plot/phone_averages.h"

#include <algorithm>

#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

constexpr int points = 21;

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

std::vector<double> list(const Eigen::ArrayXd& values) { return {values.begin(), values.end()}; }

}  // namespace

void PhoneAverages::add(const FrameLabels& labels, const std::vector<Eigen::VectorXd>& lines) {
  const auto& all = labels.labels;
  for (std::size_t start = 0, end = 0; start < all.size(); start = end) {
    while (end < all.size() && all[end] == all[start]) ++end;
    if (is_pause(all[start])) continue;
    auto& sums = phones_[all[start]];
    if (sums.count++ == 0) sums.values = sums.squares = Eigen::ArrayXXd::Zero(points, std::ssize(lines));
    for (Eigen::Index i = 0; i < std::ssize(lines); ++i) {
      const Eigen::ArrayXd line = stretched(lines[static_cast<std::size_t>(i)], static_cast<double>(start) - margin_,
                                            static_cast<double>(end) - 1 + margin_);
      sums.values.col(i) += line;
      sums.squares.col(i) += line.square();
    }
  }
}

std::vector<std::string> PhoneAverages::most_frequent(int count) const {
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [phone, sums] : phones_) order.emplace_back(-sums.count, phone);
  std::sort(order.begin(), order.end());
  order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(count)));
  std::vector<std::string> out;
  for (const auto& [negative, phone] : order) out.push_back(phone);
  return out;
}

Panel PhoneAverages::panel(const std::string& phone, const std::vector<std::string>& names, bool band) const {
  const auto met = phones_.find(phone);
  const int count = met == phones_.end() ? 0 : met->second.count;
  Panel panel{phone + " (" + std::to_string(count) + ")", "time within the phone and its margin", "", {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto& line = panel.series.emplace_back();
    line.name = names[i];
    if (count == 0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::ArrayXd mean = met->second.values.col(at) / count;
    line.x = list(Eigen::ArrayXd::LinSpaced(points, 0, 1));
    line.y = list(mean);
    line.band = band;
    if (band) line.spread = list((met->second.squares.col(at) / count - mean.square()).cwiseMax(0).sqrt());
  }
  return panel;
}

}  // namespace talkgraph
