#include "nodes/mapping/joint_gmm.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <tuple>

#include "nodes/latent/em.h"
#include "nodes/latent/gmm.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/scaling.h"
#include "nodes/mapping/trajectory_error.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

/// Splits the Gaussians of x and y into those of x and of y given x.
void condition(JointGmm& model, const GaussianMixture& joint, Eigen::Index heard) {
  const Eigen::Index seen = joint.dimension() - heard;
  model.sound = {joint.weights, joint.means.leftCols(heard), {}};
  model.means.resize(joint.components(), seen);
  model.variances.resize(joint.components(), seen);
  for (Eigen::Index m = 0; m < joint.components(); ++m) {
    const Eigen::MatrixXd& covariance = joint.covariances[static_cast<std::size_t>(m)];
    const Eigen::MatrixXd of_sound = covariance.topLeftCorner(heard, heard),
                          across = covariance.topRightCorner(heard, seen);
    const Eigen::MatrixXd regression = of_sound.llt().solve(across).transpose();
    model.sound.covariances.push_back(of_sound);
    model.means.row(m) = joint.means.row(m).tail(seen) - joint.means.row(m).head(heard) * regression.transpose();
    model.variances.row(m) = covariance.diagonal().tail(seen).transpose() -
                             regression.cwiseProduct(across.transpose()).rowwise().sum().transpose();
    model.regressions.push_back(regression);
  }
}

/// The likeliest components given scaled sound, and what they make of it.
StatePath path_of(const JointGmm& model, const Eigen::MatrixXd& audio) {
  StatePath path{frames_and_slopes(audio.rows()), {}, Eigen::VectorXd::Ones(audio.rows()), {}};
  const Eigen::MatrixXd x = blocks_beside(path.rows, 2, audio), logs = log_joint(model.sound, x);
  path.shifts.resize(x.rows(), model.means.cols());
  for (Eigen::Index t = 0; t < x.rows(); ++t) {
    Eigen::Index likeliest = 0;
    logs.row(t).maxCoeff(&likeliest);
    path.states.push_back(likeliest);
    path.shifts.row(t) = x.row(t) * model.regressions[static_cast<std::size_t>(likeliest)].transpose();
  }
  return path;
}

StateGaussians gaussians_of(const JointGmm& model) { return {model.means, model.variances, 2}; }

}  // namespace

JointGmm TrainJointGmm::operator()(const Collected<Track>& audio, const Collected<Track>& visual, Random& random,
                                   Context& context) const {
  const JoinedStreams both = side_by_side(audio, visual);
  const Sequences data = measured_runs(both.tracks);
  JointGmm model;
  std::tie(model.audio, model.visual) = split(scaling_of(data.frames), both.audio);
  const Eigen::MatrixXd heard = scaled(model.audio, data.frames.leftCols(both.audio)),
                        seen = scaled(model.visual, data.frames.rightCols(model.visual.mean.size()));
  Eigen::MatrixXd joint(heard.rows(), 2 * data.frames.cols());
  joint << blocks_beside(frames_and_slopes, 2, heard, data.lengths),
      blocks_beside(frames_and_slopes, 2, seen, data.lengths);
  TrainGmm mixture;
  mixture.components = components;
  mixture.floor = floor;
  mixture.iterations = iterations;
  mixture.tolerance = tolerance;
  const Gmm trained = mixture.fit(joint, random, context);
  model.trace = trained.trace;
  condition(model, trained.mixture, 2 * both.audio);

  std::vector<StatePath> paths;
  Eigen::Index start = 0;
  for (const auto length : data.lengths) {
    paths.push_back(path_of(model, heard.middleRows(start, length)));
    start += length;
  }
  StateGaussians states = gaussians_of(model);
  model.errors =
      lower_error(states, paths, seen, descent, fmt::format("{} components", model.sound.components()), context);
  model.means = std::move(states.means);
  model.variances = std::move(states.variances);
  return model;
}

Track SynthesiseJointGmm::operator()(const JointGmm& model, const Track& audio) const {
  require_frames_of(audio, model.audio.mean.size(), "the joint mixture");
  const StatePath path = path_of(model, scaled(model.audio, audio.values));
  return {restored(model.visual, trajectory(gaussians_of(model), path)), audio.rate, audio.start, {}, {}};
}

void describe(Description<TrainJointGmm>& d) {
  d.type("mapping.joint_gmm").version(1).stored();
  d.summary("a mixture over sound and face, refined until the trajectories it converts sound to miss least");
  d.source("Zhuang, Wang, Soong and Hasegawa-Johnson 2010; thesis §4.2.2");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .output("model", "the mixture of the sound, and the face given each component");
  d.param("components", &TrainJointGmm::components).at_least(1).doc("fewer if there are fewer distinct frames");
  describe_em(d, "a component");
  d.param("descent", &TrainJointGmm::descent)
      .at_least(0)
      .doc("most steps down the error of trajectories; 0 leaves the likeliest mixture");
}

void describe(Description<SynthesiseJointGmm>& d) {
  d.type("mapping.joint_gmm_synthesise").version(1);
  d.summary("the likeliest trajectory of visual parameters given sound, under a joint mixture");
  d.source("Toda, Black and Tokuda 2007; Zhuang, Wang, Soong and Hasegawa-Johnson 2010");
  d.input("model", "of mapping.joint_gmm")
      .input("audio", "speech features at the video rate")
      .output("visual", "visual parameters");
}

}  // namespace talkgraph
