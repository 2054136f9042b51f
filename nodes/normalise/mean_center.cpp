#include "nodes/normalise/mean_center.h"

#include <cmath>
#include <stdexcept>

namespace talkgraph {

MeanCenter::Out MeanCenter::operator()(const Track& track, const Mask* usable) const {
  if (!track.values.allFinite()) throw std::runtime_error("a track with NaN or infinite values has no mean");
  if (usable && std::abs(track.frames() - static_cast<Eigen::Index>(usable->frames.size())) > 2)
    throw std::runtime_error("a mask of " + std::to_string(usable->frames.size()) + " frames does not fit a track of " +
                             std::to_string(track.frames()));
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(track.dimension());
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (usable && (i >= usable->frames.size() || !usable->frames[i])) continue;
    sum += track.values.row(t);
    ++count;
  }
  if (count == 0) throw std::runtime_error("a track without a usable frame has no mean");
  Out out{track, track};
  out.mean.values = sum / static_cast<double>(count);
  out.centred.values.rowwise() -= out.mean.values.row(0);
  return out;
}

void describe(Description<MeanCenter>& d) {
  d.type("normalise.mean_center").summary("takes each sequence's mean off").source("Thesis §3.4, Eqn 3.36");
  d.input("track").input("usable", "frames that count for the mean; all if not given");
  d.output("centred", &MeanCenter::Out::centred).output("mean", &MeanCenter::Out::mean, "1 x D");
}

}  // namespace talkgraph
