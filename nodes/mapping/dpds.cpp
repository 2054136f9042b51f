#include "nodes/mapping/dpds.h"

#include <fmt/format.h>

#include <algorithm>

#include "nodes/latent/lbfgs.h"
#include "nodes/latent/normal.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/dpds_objective.h"
#include "nodes/mapping/phone_chain.h"
#include "nodes/mapping/phone_inventory.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

StateRuns runs_of(const std::vector<std::string>& phones, const std::vector<std::string>& labels,
                  const std::vector<std::int64_t>& lengths) {
  StateRuns runs{{}, std::ssize(phones)};
  auto label = labels.begin();
  for (const auto length : lengths) {
    auto& sequence = runs.sequences.emplace_back();
    for (std::int64_t t = 0; t < length; ++t) sequence.push_back(place_of(phones, *label++));
  }
  return runs;
}

/// What a state begins with that begins no sequence: the mean of its frames.
void fill_first(Dpds& model, const StateRuns& runs, const Eigen::MatrixXd& frames) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(model.first.rows(), model.first.cols());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(runs.states);
  std::vector<bool> begins(static_cast<std::size_t>(runs.states));
  Eigen::Index row = 0;
  for (const auto& states : runs.sequences) {
    begins[static_cast<std::size_t>(states[0])] = true;
    for (const Eigen::Index state : states) {
      sums.row(state) += frames.row(row++);
      counts[state] += 1;
    }
  }
  for (Eigen::Index k = 0; k < runs.states; ++k)
    if (!begins[static_cast<std::size_t>(k)]) model.first.row(k) = sums.row(k) / counts[k];
}

/// Adds a dimension's log-likelihoods to those of all; the shorter of the two stays at its last.
void add_trace(std::vector<double>& all, const std::vector<double>& costs) {
  const std::size_t length = std::max(all.size(), costs.size());
  all.resize(length, all.empty() ? 0 : all.back());
  for (std::size_t i = 0; i < length; ++i) all[i] -= costs[std::min(i, costs.size() - 1)];
}

}  // namespace

Dpds TrainDpds::operator()(const Collected<Track>& visual, const Collected<FrameLabels>& labels,
                           Context& context) const {
  const Labelled training = labelled(visual, labels);
  const Sequences data = measured_runs(training.tracks);
  Dpds model;
  model.visual = scaling_of(data.frames);
  model.chain = phone_chain(training.labels, data.lengths);
  const Eigen::MatrixXd frames = scaled(model.visual, data.frames);
  const StateRuns runs = runs_of(model.chain.phones, training.labels, data.lengths);
  const Eigen::Index dims = frames.cols();
  const Eigen::VectorXd floors = variance_floors(frames, floor);
  model.first.resize(runs.states, dims);
  model.prediction = model.offset = model.first;
  model.noise.resize(dims);
  Lbfgs optimiser;
  optimiser.iterations = iterations;
  optimiser.on_iteration = [&](int, double) { context.check_cancelled(); };
  Eigen::Index unsettled = 0;
  for (Eigen::Index d = 0; d < dims; ++d) {
    const Eigen::VectorXd values = frames.col(d);
    DpdsObjective objective(runs, values, floors[d], bound);
    Eigen::VectorXd parameters = Eigen::VectorXd::Constant(runs.states, 0.5);
    const OptimiserReport report = optimiser.minimise(objective, parameters);
    double cost = 0;
    objective.evaluate(parameters, cost, nullptr);
    model.first.col(d) = objective.first();
    model.prediction.col(d) = objective.prediction();
    model.offset.col(d) = objective.offset();
    model.noise[d] = objective.noise();
    add_trace(model.trace, report.trace);
    unsettled += report.reason == StopReason::iterations;
    context.progress(static_cast<double>(d + 1) / static_cast<double>(dims));
  }
  fill_first(model, runs, frames);
  context.log(
      fmt::format("DPDS of {} phones, {} frames: log-likelihood {:.8g}, {:.5g} a frame, {} of {} dimensions "
                  "converged",
                  runs.states, frames.rows(), model.trace.back(),
                  model.trace.back() / static_cast<double>(frames.rows()), dims - unsettled, dims));
  return model;
}

void describe(Description<TrainDpds>& d) {
  d.type("mapping.dpds").version(1).stored();
  d.summary("learns a deterministic process dynamical system of the face, with phones as states");
  d.source("Thesis §5.1.2, Eqns 5.9-5.11; Englebienne, Cootes and Rattray 2007");
  d.input("visual", "visual parameters of the training sequences")
      .input("labels", "phones at the video rate of the training sequences")
      .output("model", "the dynamics of each phone");
  d.param("bound", &TrainDpds::bound)
      .within(0, 1)
      .doc("most |A|, below 1 so that a long phone comes to rest; 0: none, as in the source");
  d.param("floor", &TrainDpds::floor).positive().doc("least variance of the noise, as a share of the frames' variance");
  d.param("iterations", &TrainDpds::iterations).at_least(0).doc("limit of L-BFGS, a dimension");
}

}  // namespace talkgraph
