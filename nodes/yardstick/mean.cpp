#include "nodes/yardstick/mean.h"

#include <stdexcept>

namespace talkgraph {

MeanModel MeanTrain::operator()(const Collected<Track>& visual) const {
  if (visual.empty()) throw std::runtime_error("the mean of no tracks: is the training selection empty?");
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(visual[0].dimension());
  Eigen::Index frames = 0;
  for (std::size_t i = 0; i < visual.size(); ++i) {
    if (visual[i].dimension() != sum.size())
      throw std::runtime_error(visual.key(i) + ": " + std::to_string(visual[i].dimension()) +
                               " dimensions, others have " + std::to_string(sum.size()));
    if (!visual[i].values.allFinite()) throw std::runtime_error(visual.key(i) + ": NaN or infinite values");
    for (Eigen::Index t = 0; t < visual[i].frames(); ++t) {
      if (visual[i].is_lost(t)) continue;
      sum += visual[i].values.row(t);
      ++frames;
    }
  }
  if (frames == 0) throw std::runtime_error("the mean of tracks without frames");
  return {sum / static_cast<double>(frames)};
}

Track MeanPredict::operator()(const MeanModel& model, const Track& audio) const {
  Track out;
  out.rate = audio.rate;
  out.start = audio.start;
  out.values = model.mean.replicate(audio.frames(), 1);
  return out;
}

void describe(Description<MeanTrain>& d) {
  d.type("yardstick.mean_train").summary("the mean of all training frames");
  d.input("visual", "visual parameters of the training sequences").output("model", "mean row");
}

void describe(Description<MeanPredict>& d) {
  d.type("yardstick.mean").summary("predicts the training mean for every frame");
  d.input("model", "of yardstick.mean_train")
      .input("audio", "speech features, whose frames are filled")
      .output("track", "visual parameters");
}

}  // namespace talkgraph
