#include "nodes/types/joint_gmm.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const JointGmm& g) {
  const StoredModel stored("joint mixture");
  const Eigen::Index m = g.sound.components(), heard = g.audio.mean.size(), seen = g.visual.mean.size();
  stored.scaling("audio", g.audio, heard);
  stored.scaling("visual", g.visual, seen);
  stored.mixture("sound", g.sound, 2 * heard);
  stored.require(std::ssize(g.regressions) == m, "regressions", "are not one a component");
  for (const auto& regression : g.regressions) stored.matrix("regressions", regression, 2 * seen, 2 * heard);
  stored.matrix("means", g.means, m, 2 * seen);
  stored.variances("variances", g.variances, m, 2 * seen);
}

}  // namespace

void fields(Archive& ar, JointGmm& g) {
  ar("audio", g.audio);
  ar("visual", g.visual);
  ar("sound", g.sound);
  ar("regressions", g.regressions);
  ar("means", g.means);
  ar("variances", g.variances);
  ar("trace", g.trace);
  ar("errors", g.errors);
  if (ar.loading()) check(g);
}

}  // namespace talkgraph
