#include "nodes/mapping/phone_gaussians.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "nodes/latent/cholesky.h"
#include "nodes/latent/normal.h"
#include "nodes/latent/scg.h"
#include "nodes/mapping/paired.h"
#include "nodes/mapping/scaling.h"
#include "nodes/mapping/trajectory_fit.h"

namespace talkgraph {

namespace {

using Phones = std::vector<Eigen::Index>;

/// One over the number of frames that the phone of each frame lasts there.
Eigen::VectorXd duration_weights(const Phones& phones) {
  Eigen::VectorXd weights(std::ssize(phones));
  for (auto first = phones.begin(); first != phones.end();) {
    const auto end = std::find_if(first, phones.end(), [&](Eigen::Index p) { return p != *first; });
    weights.segment(first - phones.begin(), end - first).setConstant(1 / static_cast<double>(end - first));
    first = end;
  }
  return weights;
}

/// The trajectories of one sequence, a dimension at a time.
class SequenceFit {
 public:
  SequenceFit(const PhoneGaussians& model, const Phones& phones)
      : model_(model),
        phones_(phones),
        rows_(frames_and_differences(frames(), model.order)),
        weights_(duration_weights(phones)) {}

  Eigen::Index frames() const { return std::ssize(phones_); }

  TrajectoryFit operator()(Eigen::Index dimension) const {
    Eigen::VectorXd precisions = Eigen::VectorXd::Constant(rows_.rows(), model_.smoothness);
    Eigen::VectorXd targets = Eigen::VectorXd::Zero(rows_.rows());
    precisions.head(frames()) = weights_.array() / model_.variances.col(dimension)(phones_).array();
    targets.head(frames()) = model_.means.col(dimension)(phones_);
    return {rows_, std::move(precisions), std::move(targets)};
  }

  /// Adds the derivatives of a cost by means and logarithms of variances, given those by the trajectory's frames.
  void add_gradient(const TrajectoryFit& fit, const Eigen::VectorXd& by_frames, Eigen::Index dimension,
                    Eigen::Ref<Eigen::MatrixXd> by_means, Eigen::Ref<Eigen::MatrixXd> by_logs) const {
    const TrajectoryFit::Gradient by = fit.gradient(by_frames);
    for (Eigen::Index t = 0; t < frames(); ++t) {
      const Eigen::Index phone = phones_[static_cast<std::size_t>(t)];
      by_means(phone, dimension) += by.targets(t);
      by_logs(phone, dimension) -= by.precisions(t) * weights_(t) / model_.variances(phone, dimension);
    }
  }

 private:
  const PhoneGaussians& model_;
  const Phones& phones_;
  TrajectoryRows rows_;
  Eigen::VectorXd weights_;
};

Eigen::Index row_of(const PhoneGaussians& model, const std::string& phone) {
  const auto at = std::lower_bound(model.phones.begin(), model.phones.end(), phone);
  return at != model.phones.end() && *at == phone ? at - model.phones.begin() : std::ssize(model.phones);
}

/// Means and variances over each phone's frames.
void learn_gaussians(PhoneGaussians& model, const Eigen::MatrixXd& frames, const Phones& phones, double floor) {
  const Eigen::Index count = std::ssize(model.phones), dimensions = frames.cols();
  Eigen::MatrixXd in = Eigen::MatrixXd::Zero(frames.rows(), count);
  for (Eigen::Index n = 0; n < frames.rows(); ++n) in(n, phones[static_cast<std::size_t>(n)]) = 1;
  const Eigen::VectorXd frames_of = in.colwise().sum();
  const Eigen::MatrixXd means = frames_of.cwiseInverse().asDiagonal() * (in.transpose() * frames);
  const Eigen::MatrixXd squares = (frames - in * means).cwiseAbs2();
  const Eigen::MatrixXd variances = frames_of.cwiseInverse().asDiagonal() * (in.transpose() * squares);
  model.means.setZero(count + 1, dimensions);
  model.means.topRows(count) = means;
  model.variances.setOnes(count + 1, dimensions);
  model.variances.topRows(count) = variances.cwiseMax(variance_floors(frames, floor).transpose().replicate(count, 1));
}

}  // namespace

Eigen::MatrixXd trajectory(const PhoneGaussians& model, const std::vector<Eigen::Index>& phones) {
  const SequenceFit fit(model, phones);
  Eigen::MatrixXd values(fit.frames(), model.means.cols());
  if (fit.frames() == 0) return values;
  for (Eigen::Index d = 0; d < values.cols(); ++d) values.col(d) = fit(d).trajectory();
  return values;
}

Eigen::VectorXd PhoneTrajectoryError::parameters(const PhoneGaussians& model) {
  Eigen::VectorXd all(2 * model.means.size());
  all << model.means.reshaped(), model.variances.array().log().matrix().reshaped();
  return all;
}

void PhoneTrajectoryError::assign(PhoneGaussians& model, const Eigen::VectorXd& parameters) {
  const Eigen::Index n = model.means.size();
  model.means.reshaped() = parameters.head(n);
  model.variances.reshaped() = parameters.tail(n).unaryExpr([](double x) { return std::exp(x); });
}

bool PhoneTrajectoryError::evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) {
  assign(model_, parameters);
  Eigen::MatrixXd by_means = Eigen::MatrixXd::Zero(model_.means.rows(), model_.means.cols()), by_logs = by_means;
  cost = 0;
  const double frames = static_cast<double>(data_.frames.rows());
  Eigen::Index start = 0;
  try {
    for (const auto length : data_.lengths) {
      const Phones phones(phones_.begin() + start, phones_.begin() + start + length);
      const SequenceFit sequence(model_, phones);
      for (Eigen::Index d = 0; d < model_.means.cols(); ++d) {
        const TrajectoryFit fit = sequence(d);
        const Eigen::VectorXd error = fit.trajectory() - data_.frames.col(d).segment(start, length);
        cost += 0.5 * error.squaredNorm() / frames;
        if (gradient) sequence.add_gradient(fit, error / frames, d, by_means, by_logs);
      }
      start += length;
    }
  } catch (const FactorisationError&) {
    return false;
  }
  if (gradient) {
    gradient->resize(size());
    *gradient << by_means.reshaped(), by_logs.reshaped();
  }
  return std::isfinite(cost);
}

PhoneGaussians TrainPhoneGaussians::operator()(const Collected<Track>& visual, const Collected<FrameLabels>& labels,
                                               Context& context) const {
  const Labelled all = labelled(visual, labels);
  Sequences data = measured_runs(all.tracks);
  PhoneGaussians model;
  model.smoothness = smoothness;
  model.order = order;
  model.scaling = scaling_of(data.frames);
  data.frames = scaled(model.scaling, data.frames);
  const std::set<std::string> phones(all.labels.begin(), all.labels.end());
  model.phones.assign(phones.begin(), phones.end());
  Phones rows;
  for (const auto& label : all.labels) rows.push_back(row_of(model, label));
  learn_gaussians(model, data.frames, rows, floor);

  PhoneTrajectoryError error(model, data, rows);
  Eigen::VectorXd parameters = PhoneTrajectoryError::parameters(model);
  ScaledConjugateGradients descent;
  descent.iterations = iterations;
  descent.on_iteration = [&](int i, double) {
    context.check_cancelled();
    context.progress(static_cast<double>(i) / iterations);
  };
  OptimiserReport report = descent.minimise(error, parameters);
  if (report.iterations > 0) PhoneTrajectoryError::assign(model, parameters);
  const double dimensions = static_cast<double>(model.means.cols());
  for (const double cost : report.trace) model.trace.push_back(2 * cost / dimensions);
  context.log(
      fmt::format("{} phones, {} frames: mean squared error of trajectories {:.4g}, {:.4g} after {} iterations ({})",
                  model.phones.size(), data.frames.rows(), model.trace.front(), model.trace.back(), report.iterations,
                  str(report.reason)));
  return model;
}

Track SynthesisePhoneGaussians::operator()(const PhoneGaussians& model, const FrameLabels& labels) const {
  Phones rows;
  for (const auto& label : labels.labels) rows.push_back(row_of(model, label));
  Track out;
  out.values = restored(model.scaling, trajectory(model, rows));
  out.rate = labels.rate;
  out.start = 0.5 / labels.rate.value();
  return out;
}

void describe(Description<TrainPhoneGaussians>& d) {
  d.type("mapping.phone_gaussians").version(1).stored();
  d.summary("learns a Gaussian of visual parameters a phone for trajectories that go smoothly through them");
  d.source("Ezzat, Geiger and Poggio 2002; thesis §4.2.2, Eqn 4.8");
  d.input("visual", "visual parameters of the training sequences")
      .input("labels", "their phones at that rate")
      .output("model", "means and variances a phone");
  d.param("smoothness", &TrainPhoneGaussians::smoothness)
      .positive()
      .doc("λ, of parameters scaled to deviation 1; a phone weighs the same however long it lasts");
  d.param("order", &TrainPhoneGaussians::order).within(1, 10).doc("of the differences along time that are kept small");
  d.param("floor", &TrainPhoneGaussians::floor)
      .positive()
      .doc("least variance that descent starts from, as a share of the frames' variance");
  d.param("iterations", &TrainPhoneGaussians::iterations)
      .at_least(0)
      .doc("limit of the descent on the error of trajectories; 0 leaves means and variances as the frames have them");
}

void describe(Description<SynthesisePhoneGaussians>& d) {
  d.type("mapping.phone_gaussians_synthesise").version(1);
  d.summary("a smooth trajectory of visual parameters through the Gaussians of phones");
  d.source("Ezzat, Geiger and Poggio 2002; thesis §4.2.2, Eqn 4.8");
  d.input("model", "of mapping.phone_gaussians")
      .input("labels", "phones at the video rate")
      .output("visual", "visual parameters");
}

}  // namespace talkgraph
