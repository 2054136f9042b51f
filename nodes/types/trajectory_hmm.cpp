#include "nodes/types/trajectory_hmm.h"

namespace talkgraph {

void fields(Archive& ar, ContextNode& n) {
  ar("place", n.place);
  ar("viseme", n.viseme);
  ar("phone", n.phone);
  ar("yes", n.yes);
  ar("no", n.no);
  ar("row", n.row);
}

void fields(Archive& ar, TiedGaussians& g) {
  ar("nodes", g.nodes);
  ar("means", g.means);
  ar("variances", g.variances);
}

void fields(Archive& ar, TrajectoryHmm& h) {
  ar("audio", h.audio);
  ar("visual", h.visual);
  ar("start", h.start);
  ar("transitions", h.transitions);
  ar("sound", h.sound);
  ar("face", h.face);
  ar("trace", h.trace);
  ar("errors", h.errors);
}

}  // namespace talkgraph
