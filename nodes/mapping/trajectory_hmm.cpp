#include "nodes/mapping/trajectory_hmm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "nodes/latent/em.h"
#include "nodes/latent/hmm.h"
#include "nodes/latent/normal.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

MarkovChain chain_of(const TrajectoryHmm& model) {
  const auto log = [](double p) { return std::log(p); };
  return {model.start.unaryExpr(log), model.transitions.unaryExpr(log)};
}

/// Any state first, and of it and those behind it any next.
void start_chain(TrajectoryHmm& model, Eigen::Index states) {
  model.start.setConstant(states, 1 / static_cast<double>(states));
  model.transitions.setZero(states, states);
  for (Eigen::Index s = 0; s < states; ++s)
    model.transitions.row(s).tail(states - s).setConstant(1 / static_cast<double>(states - s));
}

/// One stream of training frames and its Gaussians.
struct Stream {
  TiedGaussians& tied;
  Eigen::MatrixXd frames;  ///< with slopes and curvatures
  Eigen::VectorXd floors;

  Stream(TiedGaussians& gaussians, Eigen::MatrixXd observed, double floor)
      : tied(gaussians), frames(std::move(observed)), floors(variance_floors(frames, floor)) {}
};

/// Expectation maximisation of the states inside phones, whose times are known.
class PhoneEm {
 public:
  PhoneEm(TrajectoryHmm& model, std::vector<PhoneRun> runs, Stream sound, Stream face)
      : model_(model), runs_(std::move(runs)), streams_{std::move(sound), std::move(face)} {
    for (const PhoneRun& run : runs_) contexts_.push_back(run.context);
    std::sort(contexts_.begin(), contexts_.end());
    contexts_.erase(std::unique(contexts_.begin(), contexts_.end()), contexts_.end());
    cut_evenly();
  }

  /// Trees over the frames as they are in states now, and their Gaussians.
  void tie(TreeLimits limits) {
    const Eigen::Index states = model_.start.size();
    for (Stream& stream : streams_) {
      std::vector<FrameSums> sums(static_cast<std::size_t>(states), {std::ssize(contexts_), stream.frames.cols()});
      for (const PhoneRun& run : runs_) {
        const auto context = std::lower_bound(contexts_.begin(), contexts_.end(), run.context) - contexts_.begin();
        for (Eigen::Index s = 0; s < states; ++s) add(sums[static_cast<std::size_t>(s)], context, stream, run, s);
      }
      limits.floors = stream.floors;
      stream.tied = grow_trees(contexts_, sums, limits);
    }
    maximise_gaussians();
  }

  double expect() {
    const MarkovChain chain = chain_of(model_);
    starts_.setZero(model_.start.size());
    steps_.setZero(model_.start.size(), model_.start.size());
    double log_likelihood = 0;
    for (const PhoneRun& run : runs_) {
      Eigen::MatrixXd densities = Eigen::MatrixXd::Zero(run.frames, model_.start.size());
      for (const Stream& stream : streams_)
        densities += log_densities(stream.tied, rows_of(stream.tied, run.context, densities.cols()),
                                   stream.frames.middleRows(run.first, run.frames));
      const ChainPosterior p = forward_backward(chain, densities);
      positions_.middleRows(run.first, run.frames) = p.states;
      starts_ += p.states.row(0).transpose();
      steps_ += p.steps;
      log_likelihood += p.log_likelihood;
    }
    return log_likelihood;
  }

  void maximise() {
    model_.start = starts_ / starts_.sum();
    for (Eigen::Index s = 0; s < steps_.rows(); ++s)
      if (const double left = steps_.row(s).sum(); left > 1e-12) model_.transitions.row(s) = steps_.row(s) / left;
    maximise_gaussians();
  }

 private:
  void cut_evenly() {
    const Eigen::Index states = model_.start.size();
    positions_.setZero(streams_[0].frames.rows(), states);
    for (const PhoneRun& run : runs_)
      for (Eigen::Index t = 0; t < run.frames; ++t)
        positions_(run.first + t, (2 * t + 1) * states / (2 * run.frames)) = 1;
  }

  void add(FrameSums& sums, Eigen::Index kind, const Stream& stream, const PhoneRun& run, Eigen::Index state) const {
    sums.add(kind, stream.frames.middleRows(run.first, run.frames),
             positions_.col(state).segment(run.first, run.frames));
  }

  void maximise_gaussians() {
    for (Stream& stream : streams_) {
      FrameSums sums(stream.tied.means.rows(), stream.frames.cols());
      for (const PhoneRun& run : runs_) {
        const std::vector<Eigen::Index> rows = rows_of(stream.tied, run.context, positions_.cols());
        for (Eigen::Index s = 0; s < positions_.cols(); ++s)
          add(sums, rows[static_cast<std::size_t>(s)], stream, run, s);
      }
      talkgraph::maximise(stream.tied, sums, stream.floors);
    }
  }

  TrajectoryHmm& model_;
  std::vector<PhoneRun> runs_;
  std::vector<PhoneContext> contexts_;  ///< each once, sorted
  std::array<Stream, 2> streams_;
  Eigen::MatrixXd positions_;  ///< p(state inside its phone), N × S
  Eigen::VectorXd starts_;
  Eigen::MatrixXd steps_;
};

/// Of every training sequence.
std::vector<StatePath> paths_of(const TrajectoryHmm& model, const Eigen::MatrixXd& audio,
                                const std::vector<std::string>& labels, const std::vector<std::int64_t>& lengths) {
  std::vector<StatePath> paths;
  auto label = labels.begin();
  for (Eigen::Index start = 0; const auto length : lengths) {
    paths.push_back(path_of(model, audio.middleRows(start, length), {label, label + length}));
    start += length;
    label += length;
  }
  return paths;
}

}  // namespace

StateGaussians face_of(const TrajectoryHmm& model) { return {model.face.means, model.face.variances, 3}; }

StatePath path_of(const TrajectoryHmm& model, const Eigen::MatrixXd& audio, const std::vector<std::string>& labels) {
  StatePath path{frames_slopes_and_curvatures(audio.rows()), {}, Eigen::VectorXd::Ones(audio.rows()), {}};
  const Eigen::MatrixXd heard = blocks_beside(path.rows, 3, audio);
  const MarkovChain chain = chain_of(model);
  for (const PhoneRun& run : phone_runs(labels, {std::ssize(labels)})) {
    const auto rows = [&](const TiedGaussians& tied) { return rows_of(tied, run.context, model.start.size()); };
    const std::vector<Eigen::Index> seen = rows(model.face);
    const Eigen::MatrixXd densities =
        log_densities(model.sound, rows(model.sound), heard.middleRows(run.first, run.frames));
    for (const Eigen::Index state : viterbi(chain, densities).states)
      path.states.push_back(seen[static_cast<std::size_t>(state)]);
  }
  return path;
}

TrajectoryHmm TrainTrajectoryHmm::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                                             const Collected<FrameLabels>& labels, Context& context) const {
  const JoinedStreams both = side_by_side(audio, visual);
  const Labelled training = labelled(both.tracks, labels);
  const Sequences data = measured_runs(training.tracks);
  TrajectoryHmm model;
  std::tie(model.audio, model.visual) = split(scaling_of(data.frames), both.audio);
  const Eigen::MatrixXd heard = scaled(model.audio, data.frames.leftCols(both.audio)),
                        seen = scaled(model.visual, data.frames.rightCols(model.visual.mean.size()));
  start_chain(model, states);
  const auto observed = [&](const Eigen::MatrixXd& frames) {
    return blocks_beside(frames_slopes_and_curvatures, 3, frames, data.lengths);
  };
  PhoneEm em(model, phone_runs(training.labels, data.lengths), {model.sound, observed(heard), floor},
             {model.face, observed(seen), floor});
  for (const bool neighbours : {false, true}) {
    em.tie({neighbours, occupancy, penalty, {}});
    model.trace = run_em(
        {iterations, tolerance}, data.frames.rows(),
        fmt::format("trajectory HMM of {} Gaussians of the sound, {} of the face", model.sound.means.rows(),
                    model.face.means.rows()),
        context, [&] { return em.expect(); }, [&] { em.maximise(); });
  }
  StateGaussians face = face_of(model);
  model.errors = lower_error(face, paths_of(model, heard, training.labels, data.lengths), seen, descent,
                             fmt::format("{} Gaussians", face.means.rows()), context);
  model.face.means = std::move(face.means);
  model.face.variances = std::move(face.variances);
  return model;
}

void describe(Description<TrainTrajectoryHmm>& d) {
  d.type("mapping.trajectory_hmm").version(2).stored();
  d.summary(
      "learns a trajectory hidden Markov model of sound and face, refined until the trajectories it generates "
      "miss least");
  d.source("Zen, Tokuda and Kitamura 2007; Wu and Wang 2006; Wang, Qian, Scott, Chen and Soong 2010");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .input("labels", "their phones at that rate")
      .output("model", "states of phones in context, and their Gaussians");
  d.param("states", &TrainTrajectoryHmm::states).at_least(1).doc("of a phone, from left to right");
  d.param("occupancy", &TrainTrajectoryHmm::occupancy).at_least(1).doc("least training frames of a Gaussian");
  d.param("penalty", &TrainTrajectoryHmm::penalty)
      .at_least(0)
      .doc("what one more Gaussian must gain, as a share of what minimum description length asks for");
  describe_em(d, "a Gaussian");
  d.param("descent", &TrainTrajectoryHmm::descent)
      .at_least(0)
      .doc("most steps down the error of trajectories; 0 leaves the likeliest Gaussians");
}

}  // namespace talkgraph
