#include "nodes/types/yardsticks.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {
Eigen::Index stacked_size(const StackedInputs& s) { return s.mean.size() * (2 * s.context + 1); }
}  // namespace

void fields(Archive& ar, StackedInputs& s) {
  ar("context", s.context);
  ar("mean", s.mean);
  ar("scale", s.scale);
  if (!ar.loading()) return;
  const StoredModel stored("model");
  stored.require(s.context >= 0 && s.context <= 50, "inputs.context", "is not from 0 to 50");
  stored.matrix("inputs.mean", s.mean, 1, s.mean.size());
  stored.matrix("inputs.scale", s.scale, 1, s.mean.size());
}

void fields(Archive& ar, MeanModel& m) { ar("mean", m.mean); }

void fields(Archive& ar, RidgeModel& m) {
  ar("inputs", m.inputs);
  ar("weights", m.weights);
  ar("offset", m.offset);
  if (!ar.loading()) return;
  const StoredModel stored("ridge regression");
  stored.matrix("weights", m.weights, stacked_size(m.inputs), m.offset.size());
  stored.matrix("offset", m.offset, 1, m.offset.size());
}

void fields(Archive& ar, NeighboursModel& m) {
  ar("inputs", m.inputs);
  ar("weights", m.weights);
  ar("audio", m.audio);
  ar("visual", m.visual);
  if (!ar.loading()) return;
  const StoredModel stored("nearest neighbours");
  stored.matrix("weights", m.weights, 1, stacked_size(m.inputs));
  stored.matrix("audio", m.audio, m.audio.rows(), stacked_size(m.inputs));
  stored.matrix("visual", m.visual, m.audio.rows(), m.visual.cols());
}

void fields(Archive& ar, TrajectoriesModel& m) {
  ar("trajectories", m.trajectories);
  ar("ending", m.ending);
  ar("mean", m.mean);
}

}  // namespace talkgraph
