#include "nodes/mapping/phone_gaussians.h"

#include <fmt/format.h>

#include <algorithm>

#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/phone_inventory.h"
#include "nodes/mapping/scaling.h"
#include "nodes/mapping/trajectory_error.h"
#include "nodes/types/paired.h"

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

StateGaussians gaussians_of(const PhoneGaussians& model) { return {model.means, model.variances, 1, model.smoothness}; }

StatePath path_through(const PhoneGaussians& model, Phones phones) {
  StatePath path;
  path.rows = frames_and_differences(std::ssize(phones), model.order);
  path.weights = duration_weights(phones);
  path.states = std::move(phones);
  return path;
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

PhoneGaussians TrainPhoneGaussians::operator()(const Collected<Track>& visual, const Collected<FrameLabels>& labels,
                                               Context& context) const {
  const Labelled all = labelled(visual, labels);
  Sequences data = measured_runs(all.tracks);
  PhoneGaussians model;
  model.smoothness = smoothness;
  model.order = order;
  model.scaling = scaling_of(data.frames);
  data.frames = scaled(model.scaling, data.frames);
  model.phones = phone_inventory(all.labels);
  Phones rows;
  for (const auto& label : all.labels) rows.push_back(place_of(model.phones, label));
  learn_gaussians(model, data.frames, rows, floor);

  std::vector<StatePath> paths;
  for (auto at = rows.begin(); const auto length : data.lengths) {
    paths.push_back(path_through(model, Phones(at, at + length)));
    at += length;
  }
  StateGaussians states = gaussians_of(model);
  model.trace =
      lower_error(states, paths, data.frames, descent, fmt::format("{} phones", model.phones.size()), context);
  model.means = std::move(states.means);
  model.variances = std::move(states.variances);
  return model;
}

Track SynthesisePhoneGaussians::operator()(const PhoneGaussians& model, const FrameLabels& labels) const {
  Phones rows;
  for (const auto& label : labels.labels) rows.push_back(place_of(model.phones, label));
  Track out;
  out.values = restored(model.scaling, trajectory(gaussians_of(model), path_through(model, std::move(rows))));
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
  d.param("descent", &TrainPhoneGaussians::descent)
      .at_least(0)
      .doc("most steps down the error of trajectories; 0 leaves means and variances as the frames have them");
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
