#include "nodes/mapping/context_gp_predict.h"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>

#include "nodes/mapping/context_covariance.h"
#include "nodes/mapping/context_frames.h"

namespace talkgraph {
namespace {

void check(const ContextGp& model, const Track& audio) {
  if (audio.dimension() != model.audio_mean.size())
    throw std::runtime_error(fmt::format("audio features of {} dimensions, the model was trained on {}",
                                         audio.dimension(), model.audio_mean.size()));
  if (!audio.values.allFinite())
    throw std::runtime_error("audio features with NaN or infinite values: look at the stage before");
}

}  // namespace

PredictContextGp::Prediction PredictContextGp::operator()(const ContextGp& model, const Track& audio,
                                                          const PhoneTrack& phones) const {
  check(model, audio);
  std::vector<Eigen::Index> all(static_cast<std::size_t>(audio.frames()));
  std::iota(all.begin(), all.end(), 0);
  const Eigen::MatrixXd k = kernel_with_training(model, context_frames(model, audio, phones, audio.frames()), all);
  const Eigen::MatrixXd near = k(Eigen::all, model.inducing);
  const Eigen::VectorXd known = (near * model.certainty).cwiseProduct(near).rowwise().sum().cwiseMin(1).cwiseMax(0);
  Track visual;
  visual.rate = audio.rate;
  visual.start = audio.start;
  Track variance = visual;
  visual.values = (k * model.weights).rowwise() + model.mean;
  variance.values = (1 + model.noise - known.array()).matrix() * model.signal;
  return {std::move(visual), std::move(variance)};
}

void describe(Description<PredictContextGp>& d) {
  d.type("mapping.context_gp_predict").version(2).summary("visual parameters of new speech by mapping.context_gp");
  d.input("model", "of mapping.context_gp")
      .input("audio", "speech features at the video rate")
      .input("phones", "with their times")
      .output("visual", &PredictContextGp::Prediction::visual, "mean of the process")
      .output("variance", &PredictContextGp::Prediction::variance, "variance of each visual parameter about it");
}

}  // namespace talkgraph
