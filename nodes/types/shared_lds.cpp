#include "nodes/types/shared_lds.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const SharedLds& s) {
  const StoredModel stored("shared linear dynamical system");
  const Eigen::Index heard = s.audio.mean.size(), seen = s.visual.mean.size();
  stored.scaling("audio", s.audio, heard);
  stored.scaling("visual", s.visual, seen);
  stored.require(s.system.dimension() == heard + seen, "system", "does not give audio and visual features");
}

}  // namespace

void fields(Archive& ar, SharedLds& s) {
  ar("audio", s.audio);
  ar("visual", s.visual);
  ar("system", s.system);
  if (ar.loading()) check(s);
}

}  // namespace talkgraph
