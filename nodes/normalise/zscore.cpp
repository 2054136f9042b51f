#include "nodes/normalise/zscore.h"

#include <stdexcept>

#include "nodes/normalise/mean_of.h"

namespace talkgraph {

Track ZscoreLearn::operator()(const Collected<Track>& tracks) const {
  Track out = MeanOf{}(tracks);
  const Eigen::RowVectorXd mean = out.values;
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(mean.size());
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto values = measured(tracks[i]);
    squares += (values.rowwise() - mean).colwise().squaredNorm();
    rows += values.rows();
  }
  const Eigen::RowVectorXd deviation = (squares / static_cast<double>(rows)).cwiseSqrt();
  // Below this only rounding varies.
  const Eigen::RowVectorXd least = 1e-10 * mean.cwiseAbs();
  out.values.resize(2, mean.size());
  out.values << mean, (deviation.array() > least.array()).select(deviation, 0.0);
  return out;
}

Track ZscoreApply::operator()(const Track& track, const Track& statistics) const {
  if (statistics.frames() != 2 || statistics.dimension() != track.dimension())
    throw std::runtime_error("statistics of " + std::to_string(statistics.frames()) + " x " +
                             std::to_string(statistics.dimension()) + " do not fit a track of " +
                             std::to_string(track.dimension()) + " dimensions");
  const auto deviation = statistics.values.row(1).array();
  const Eigen::RowVectorXd scale = (deviation > 0).select(1 / deviation, 0.0);
  Track out = track;
  out.values = (track.values.rowwise() - statistics.values.row(0)) * scale.asDiagonal();
  return out;
}

void describe(Description<ZscoreLearn>& d) {
  d.type("normalise.zscore_learn").version(2).summary("mean and standard deviation of each dimension");
  d.input("tracks", "to learn from").output("statistics", "2 x D: mean, standard deviation");
}

void describe(Description<ZscoreApply>& d) {
  d.type("normalise.zscore_apply").summary("brings each dimension to mean 0 and deviation 1");
  d.input("track", "rows of that length")
      .input("statistics", "of normalise.zscore_learn")
      .output("track", "the same, scaled");
}

}  // namespace talkgraph
