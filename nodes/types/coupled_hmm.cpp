#include "nodes/types/coupled_hmm.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

void fields(Archive& ar, CoupledChain& c) {
  ar("start", c.start);
  ar("transitions", c.transitions);
  ar("observations", c.observations);
}

namespace {

void check_chain(const StoredModel& stored, const std::string& member, const CoupledChain& c, Eigen::Index pairs,
                 Eigen::Index dimension) {
  stored.matrix(member + ".start", c.start, c.states(), 1);
  stored.weights(member + ".start", c.start);
  stored.matrix(member + ".transitions", c.transitions, pairs, c.states());
  stored.weights(member + ".transitions", c.transitions);
  stored.mixtures(member + ".observations", c.observations, c.states(), dimension);
}

void check(const CoupledHmm& c) {
  const StoredModel stored("coupled hidden Markov model");
  const Eigen::Index heard = c.audio_scaling.mean.size(), seen = c.visual_scaling.mean.size();
  stored.scaling("audio_scaling", c.audio_scaling, heard);
  stored.scaling("visual_scaling", c.visual_scaling, seen);
  stored.require(c.changes >= 0 && c.changes <= 2 && heard % (1 + c.changes) == 0, "changes",
                 "are not those of the audio frames");
  const Eigen::Index pairs = c.audio.states() * c.visual.states();
  check_chain(stored, "audio", c.audio, pairs, heard);
  check_chain(stored, "visual", c.visual, pairs, seen);
}

}  // namespace

void fields(Archive& ar, CoupledHmm& c) {
  ar("audio_scaling", c.audio_scaling);
  ar("visual_scaling", c.visual_scaling);
  ar("changes", c.changes);
  ar("audio", c.audio);
  ar("visual", c.visual);
  ar("trace", c.trace);
  if (ar.loading()) check(c);
}

}  // namespace talkgraph
