#include "nodes/yardstick/ridge.h"

#include <Eigen/Cholesky>

#include "nodes/yardstick/stacked.h"

namespace talkgraph {

RidgeModel RidgeTrain::operator()(const Collected<Track>& audio, const Collected<Track>& visual) const {
  const auto training = stack_training(audio, visual, context);
  const auto n = static_cast<double>(training.audio.rows());
  const Eigen::RowVectorXd audio_mean = training.audio.colwise().mean(), visual_mean = training.visual.colwise().mean();
  const Eigen::MatrixXd a = training.audio.rowwise() - audio_mean;
  Eigen::MatrixXd normal = a.transpose() * a;
  normal.diagonal().array() += lambda * n;
  RidgeModel model;
  model.inputs = training.inputs;
  model.weights = normal.ldlt().solve(a.transpose() * (training.visual.rowwise() - visual_mean));
  model.offset = visual_mean - audio_mean * model.weights;
  return model;
}

Track RidgePredict::operator()(const RidgeModel& model, const Track& audio) const {
  Track out;
  out.rate = audio.rate;
  out.start = audio.start;
  out.values = (stacked(model.inputs, audio) * model.weights).rowwise() + model.offset;
  return out;
}

void describe(Description<RidgeTrain>& d) {
  d.type("yardstick.ridge_train")
      .version(2)
      .summary("learns ridge regression from sound to visual parameters")
      .stored();
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "weights");
  d.param("context", &RidgeTrain::context).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("lambda", &RidgeTrain::lambda).positive().doc("penalty, relative to the number of frames");
}

void describe(Description<RidgePredict>& d) {
  d.type("yardstick.ridge").summary("predicts visual parameters by ridge regression");
  d.input("model", "of yardstick.ridge_train")
      .input("audio", "speech features at the video rate")
      .output("track", "visual parameters");
}

}  // namespace talkgraph
