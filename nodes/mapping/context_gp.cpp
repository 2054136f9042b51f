#include "nodes/mapping/context_gp.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "nodes/mapping/context_covariance.h"
#include "nodes/mapping/context_kernel.h"
#include "nodes/mapping/context_training.h"

namespace talkgraph {
namespace {

/// The learnt frames of an utterance, those of speech counting.
KernelExample example_of(const ContextTraining& training, const ContextBlock& block) {
  const ContextUtterance& u = training.utterances[block.utterance];
  const auto speech = near_speech(u, 0);
  KernelExample example;
  example.counts.resize(block.size());
  for (Eigen::Index i = 0; i < block.size(); ++i)
    example.counts[i] = speech[static_cast<std::size_t>(block.local[static_cast<std::size_t>(i)])] ? 1 : 0;
  const Eigen::Index n = training.model.window.size() / 2;
  for (Eigen::Index l = -n; l <= n; ++l) {
    auto at = block.local;
    for (auto& t : at) t = std::clamp<Eigen::Index>(t + l, 0, u.frames - 1);
    example.around.push_back(block.frames(at, Eigen::all));
  }
  example.targets = training.targets.middleRows(block.at, block.size());
  return example;
}

/// Of utterances in which anybody speaks, all parameters of variance 1.
std::vector<KernelExample> examples_of(const ContextTraining& training) {
  const auto& targets = training.targets;
  const Eigen::RowVectorXd deviation =
      (targets.colwise().squaredNorm() / static_cast<double>(targets.rows())).cwiseSqrt();
  const Eigen::RowVectorXd scale = (deviation.array() > 0).select(deviation.cwiseInverse(), 1.0);
  std::vector<KernelExample> examples;
  for (const ContextBlock& block : blocks_of(training.model, training.rows)) {
    KernelExample example = example_of(training, block);
    if (example.counts.isZero()) continue;
    example.targets.array().rowwise() *= scale.array();
    examples.push_back(std::move(example));
  }
  return examples;
}

void learn_kernel_of(ContextTraining& training, const KernelLearning& learning, Random& random, Context& context) {
  const auto examples = examples_of(training);
  if (examples.size() < 2)
    return context.warn(
        "fewer than two utterances with speech: the kernel stays as it is given, for it is learnt by leaving one out");
  ContextGp& model = training.model;
  const Eigen::Index c = model.map.cols();
  const auto kernel = learn_kernel(learning, examples, {model.window, Eigen::MatrixXd::Identity(c, c), model.noise},
                                   {model.audio_mean.size(), std::ssize(model.phones)}, random, context);
  model.window = kernel.window;
  model.noise = kernel.noise;
  model.map *= kernel.map;
  model.frames *= kernel.map;
}

/// (K + σ²I)⁻¹ (Z − mean), and the likeliest variance of the signal.
void solve(ContextTraining& training, Context& context) {
  auto& [model, utterances, rows, z] = training;
  const Eigen::MatrixXd factor = covariance_factor(model, rows, context);
  const auto lower = factor.triangularView<Eigen::Lower>();
  lower.solveInPlace(z);
  model.signal = z.colwise().squaredNorm() / static_cast<double>(rows.size());
  lower.adjoint().solveInPlace(z);
  model.weights.setZero(model.frames.rows(), z.cols());
  model.weights(rows, Eigen::all) = z;
}

/// K_uu⁻¹ − (K_uu + K_uf K_fu / noise)⁻¹ of the inducing frames u and the learnt ones f, K_uu with a jitter of 1e-6.
Eigen::MatrixXd certainty(const ContextGp& model, const std::vector<Eigen::Index>& learnt, Context& context) {
  const auto size = static_cast<Eigen::Index>(model.inducing.size());
  Eigen::MatrixXd uu(size, size), uf(size, static_cast<Eigen::Index>(learnt.size()));
  const std::vector<Eigen::Index> inducing(model.inducing.begin(), model.inducing.end());
  for (const ContextBlock& block : blocks_of(model, inducing)) {
    context.check_cancelled();
    const Eigen::MatrixXd k = kernel_with_training(model, block.frames, block.local);
    uu.middleRows(block.at, block.size()) = k(Eigen::all, inducing);
    uf.middleRows(block.at, block.size()) = k(Eigen::all, learnt);
  }
  uu.diagonal().array() += 1e-6;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
  return uu.llt().solve(identity) - (uu + uf * uf.transpose() / model.noise).llt().solve(identity);
}

}  // namespace

ContextGp TrainContextGp::operator()(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                                     const Collected<Track>& visual, Random& random, Context& context) const {
  ContextTraining training = context_training(*this, audio, phones, visual);
  if (kernel_steps > 0) learn_kernel_of(training, {kernel_steps, kernel_utterances}, random, context);
  solve(training, context);
  auto& [model, utterances, rows, z] = training;
  const auto even = thinned(rows, inducing);
  model.inducing.assign(even.begin(), even.end());
  model.certainty = certainty(model, rows, context);
  context.log(fmt::format("{} of {} frames learnt, {} phones", rows.size(), model.frames.rows(), model.phones.size()));
  return std::move(model);
}

void describe(Description<TrainContextGp>& d) {
  d.type("mapping.context_gp").version(4).stored();
  d.summary("learns a Gaussian process of visual parameters whose kernel compares sound and phones on both sides");
  d.input("audio", "speech features at the video rate of the training utterances")
      .input("phones", "their phones with times")
      .input("visual", "their visual parameters, normalised")
      .output("model", "the process");
  d.param("reach", &TrainContextGp::reach).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("width", &TrainContextGp::width).positive().unit("frames").doc("of the window over the neighbours");
  d.param("sound", &TrainContextGp::sound)
      .at_least(0)
      .doc("what unrelated sound costs, natural logarithm of the kernel");
  d.param("phones", &TrainContextGp::phones).at_least(0).doc("what a different phone costs; 0: sound alone");
  d.param("place", &TrainContextGp::place)
      .at_least(0)
      .doc("what the start of a recording, or the end of speech, costs against what is far from it; 0: not compared");
  d.param("place_time", &TrainContextGp::place_time).positive().unit("s").doc("in which these are left behind, to 1/e");
  d.param("noise", &TrainContextGp::noise).positive().doc("variance of the noise, of the signal's");
  d.param("kernel_steps", &TrainContextGp::kernel_steps)
      .at_least(0)
      .doc(
          "in which window, noise and a map of sound, phones and place are learnt by leaving out utterances; 0: as "
          "given");
  d.param("kernel_utterances", &TrainContextGp::kernel_utterances).at_least(2).doc("of a step, drawn anew for each");
  d.param("margin", &TrainContextGp::margin).at_least(0).unit("frames").doc("around speech, where all is learnt");
  d.param("pauses", &TrainContextGp::pauses).at_least(1).doc("of other frames every n-th is learnt");
  d.param("max_frames", &TrainContextGp::max_frames).at_least(1).doc("most that are learnt, at even distances");
  d.param("inducing", &TrainContextGp::inducing).at_least(1).doc("frames by which the variance is approximated");
}

}  // namespace talkgraph
