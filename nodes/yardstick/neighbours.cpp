#include "nodes/yardstick/neighbours.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "nodes/yardstick/stacked.h"

namespace talkgraph {
namespace {

/// What each column of ±`context` neighbours is multiplied by, so that squared distances weigh them.
Eigen::RowVectorXd column_weights(int context, double width, Eigen::Index dimension) {
  Eigen::RowVectorXd out = Eigen::RowVectorXd::Ones(dimension * (2 * context + 1));
  if (width > 0)
    for (int l = -context; l <= context; ++l)
      out.segment((l + context) * dimension, dimension).setConstant(std::exp(-0.5 * std::pow(l / width, 2)));
  return out;
}

}  // namespace

NeighboursModel NeighboursTrain::operator()(const Collected<Track>& audio, const Collected<Track>& visual) const {
  auto training = stack_training(audio, visual, context, scale);
  const Eigen::RowVectorXd weights = column_weights(context, width, training.inputs.mean.size());
  training.audio.array().rowwise() *= weights.array();
  return {std::move(training.inputs), weights, std::move(training.audio), std::move(training.visual)};
}

Track NeighboursPredict::operator()(const NeighboursModel& model, const Track& audio) const {
  const Eigen::MatrixXd query = stacked(model.inputs, audio).array().rowwise() * model.weights.array();
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
  d.type("yardstick.neighbours_train").version(3).summary("keeps all training frames to look neighbours up in");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "the training frames");
  d.param("context", &NeighboursTrain::context).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("width", &NeighboursTrain::width)
      .at_least(0)
      .unit("frames")
      .doc(
          "of the window exp(-(l / width)^2) by which the l-th neighbour weighs in squared distances; 0: all the same");
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
