#include "nodes/plot/phone_means.h"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "nodes/plot/columns.h"
#include "nodes/plot/phone_averages.h"

namespace talkgraph {

Plot PhoneMeans::operator()(const Collected<Track>& tracks, const Collected<FrameLabels>& labels) const {
  PhoneAverages averages(margin);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    const FrameLabels* spoken = labels.find(tracks.key(i));
    if (!spoken || track.frames() == 0) continue;
    if (std::abs(track.frames() - std::ssize(spoken->labels)) > 2)
      throw std::runtime_error(
          fmt::format("{}: {} frames and {} labels", tracks.key(i), track.frames(), spoken->labels.size()));
    std::vector<Eigen::VectorXd> lines;
    std::vector<std::string> own;
    for (Eigen::Index d = 0; d < track.dimension(); ++d) {
      lines.emplace_back(track.values.col(d));
      own.push_back(column_name(track, d));
    }
    if (names.empty()) names = own;
    if (names != own) throw std::runtime_error(tracks.key(i) + ": the dimensions are others than those before");
    averages.add(*spoken, lines);
  }
  std::vector<Panel> panels;
  for (const auto& phone : phones.empty() ? averages.most_frequent(most) : phones)
    panels.push_back(averages.panel(phone, names, band));
  return {title, draw_panels(title, panels)};
}

void describe(Description<PhoneMeans>& d) {
  d.type("plot.phone_means").summary("mean trajectories of a track's dimensions through phones, a line each");
  d.input("tracks", "sequences with few dimensions")
      .input("labels", "phones, or visemes, at the same rate")
      .output("plot", "a panel a phone");
  d.param("phones", &PhoneMeans::phones).doc("phones shown; empty: the most frequent ones");
  d.param("most", &PhoneMeans::most).within(1, 60).doc("how many of the most frequent ones");
  d.param("margin", &PhoneMeans::margin).within(0, 50).unit("frames").doc("before and after each phone");
  d.param("band", &PhoneMeans::band).doc("± a standard deviation around each line");
  d.param("title", &PhoneMeans::title).doc("heading");
}

}  // namespace talkgraph
