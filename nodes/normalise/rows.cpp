#include "nodes/normalise/rows.h"

#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {

Eigen::MatrixXd measured_rows(const Collected<Track>& tracks) {
  if (tracks.empty()) throw std::runtime_error("no tracks to learn from: is the training selection empty?");
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks[i].dimension() != tracks[0].dimension())
      throw std::runtime_error(fmt::format("{}: {} dimensions, {} has {}", tracks.key(i), tracks[i].dimension(),
                                           tracks.key(0), tracks[0].dimension()));
    count += tracks[i].frames() - std::ssize(tracks[i].lost);
  }
  Eigen::MatrixXd rows(count, tracks[0].dimension());
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    for (Eigen::Index t = 0; t < tracks[i].frames(); ++t) {
      if (tracks[i].is_lost(t)) continue;
      if (!tracks[i].values.row(t).allFinite())
        throw std::runtime_error(fmt::format("{}: a value of frame {} is not finite", tracks.key(i), t));
      rows.row(n++) = tracks[i].values.row(t);
    }
  rows.conservativeResize(n, Eigen::NoChange);
  return rows;
}

}  // namespace talkgraph
