#include "nodes/normalise/mean_center.h"

#include <stdexcept>

namespace talkgraph {

MeanCenter::Out MeanCenter::operator()(const Track& track) const {
  if (!track.values.allFinite()) throw std::runtime_error("a track with NaN or infinite values has no mean");
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(track.dimension());
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    if (track.is_lost(t)) continue;
    sum += track.values.row(t);
    ++count;
  }
  if (count == 0) throw std::runtime_error("a track without a usable frame has no mean");
  Out out{track, track};
  out.mean.values = sum / static_cast<double>(count);
  out.mean.lost.clear();
  out.centred.values.rowwise() -= out.mean.values.row(0);
  return out;
}

void describe(Description<MeanCenter>& d) {
  d.type("normalise.mean_center").summary("takes each sequence's mean off").source("Thesis §3.4, Eqn 3.36");
  d.input("track", "one sequence");
  d.output("centred", &MeanCenter::Out::centred, "the track less its mean")
      .output("mean", &MeanCenter::Out::mean, "1 x D");
}

}  // namespace talkgraph
