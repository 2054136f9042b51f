#include "nodes/normalise/mean_of.h"

#include <stdexcept>

namespace talkgraph {

Eigen::MatrixXd measured(const Track& track) {
  Eigen::MatrixXd rows(track.frames() - static_cast<Eigen::Index>(track.lost.size()), track.dimension());
  for (Eigen::Index t = 0, row = 0; t < track.frames(); ++t)
    if (!track.is_lost(t)) rows.row(row++) = track.values.row(t);
  return rows;
}

Track MeanOf::operator()(const Collected<Track>& tracks) const {
  if (tracks.empty()) throw std::runtime_error("the mean of no tracks: is the training selection empty?");
  Track out = tracks[0];
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(out.dimension());
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks[i].dimension() != out.dimension())
      throw std::runtime_error(tracks.key(i) + ": " + std::to_string(tracks[i].dimension()) +
                               " dimensions, others have " + std::to_string(out.dimension()));
    const auto values = measured(tracks[i]);
    sum += values.colwise().sum();
    rows += values.rows();
  }
  if (rows == 0) throw std::runtime_error("the mean of tracks without a measured frame");
  out.values = sum / static_cast<double>(rows);
  out.lost.clear();
  return out;
}

void describe(Description<MeanOf>& d) {
  d.type("normalise.mean_of").version(2).summary("mean row of all tracks");
  d.input("tracks", "rows of equal length").output("mean", "1 x D");
}

}  // namespace talkgraph
