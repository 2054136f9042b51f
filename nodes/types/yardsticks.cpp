#include "nodes/types/yardsticks.h"

namespace talkgraph {

void fields(Archive& ar, StackedInputs& s) {
  ar("context", s.context);
  ar("mean", s.mean);
  ar("scale", s.scale);
}

void fields(Archive& ar, MeanModel& m) { ar("mean", m.mean); }

void fields(Archive& ar, RidgeModel& m) {
  ar("inputs", m.inputs);
  ar("weights", m.weights);
  ar("offset", m.offset);
}

void fields(Archive& ar, NeighboursModel& m) {
  ar("inputs", m.inputs);
  ar("audio", m.audio);
  ar("visual", m.visual);
}

void fields(Archive& ar, TrajectoriesModel& m) {
  ar("trajectories", m.trajectories);
  ar("ending", m.ending);
  ar("mean", m.mean);
}

}  // namespace talkgraph
