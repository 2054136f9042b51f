#include "nodes/types/joint_gmm.h"

namespace talkgraph {

void fields(Archive& ar, JointGmm& g) {
  ar("audio", g.audio);
  ar("visual", g.visual);
  ar("sound", g.sound);
  ar("regressions", g.regressions);
  ar("means", g.means);
  ar("variances", g.variances);
  ar("trace", g.trace);
  ar("errors", g.errors);
}

}  // namespace talkgraph
