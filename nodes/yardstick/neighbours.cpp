#include "nodes/yardstick/neighbours.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "nodes/yardstick/stacked.h"

namespace talkgraph {

NeighboursModel NeighboursTrain::operator()(const Collected<Track>& audio, const Collected<Track>& visual) const {
  auto training = stack_training(audio, visual, context, scale);
  return {std::move(training.inputs), std::move(training.audio), std::move(training.visual)};
}

Track NeighboursPredict::operator()(const NeighboursModel& model, const Track& audio) const {
  const Eigen::MatrixXd query = stacked(model.inputs, audio);
  // |q - a|² less |q|², which does not change the order.
  Eigen::MatrixXd distance = -2 * model.audio * query.transpose();
  distance.colwise() += model.audio.rowwise().squaredNorm();
  Track out;
  out.rate = audio.rate;
  out.start = audio.start;
  out.values.setZero(audio.frames(), model.visual.cols());
  const auto nearest = std::min<Eigen::Index>(k, model.audio.rows());
  std::vector<Eigen::Index> order(static_cast<std::size_t>(model.audio.rows()));
  for (Eigen::Index t = 0; t < audio.frames(); ++t) {
    std::iota(order.begin(), order.end(), 0);
    std::partial_sort(order.begin(), order.begin() + nearest, order.end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::pair(distance(a, t), a) < std::pair(distance(b, t), b);
    });
    for (Eigen::Index i = 0; i < nearest; ++i)
      out.values.row(t) += model.visual.row(order[static_cast<std::size_t>(i)]);
    out.values.row(t) /= static_cast<double>(nearest);
  }
  return out;
}

void describe(Description<NeighboursTrain>& d) {
  d.type("yardstick.neighbours_train").version(2).summary("keeps all training frames to look neighbours up in");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "the training frames");
  d.param("context", &NeighboursTrain::context).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("scale", &NeighboursTrain::scale)
      .doc("brings every dimension of the sound to deviation 1; else they are compared as they are");
}

void describe(Description<NeighboursPredict>& d) {
  d.type("yardstick.neighbours").summary("mean of the k training frames that sound most alike").stored();
  d.input("model", "of yardstick.neighbours_train")
      .input("audio", "speech features at the video rate")
      .output("track", "visual parameters");
  d.param("k", &NeighboursPredict::k).at_least(1).doc("1 is the nearest neighbour");
}

}  // namespace talkgraph
