#include "nodes/types/dpds.h"

namespace talkgraph {

void fields(Archive& ar, Dpds& d) {
  ar("visual", d.visual);
  ar("phones", d.phones);
  ar("first", d.first);
  ar("prediction", d.prediction);
  ar("offset", d.offset);
  ar("noise", d.noise);
  ar("start", d.start);
  ar("transitions", d.transitions);
  ar("trace", d.trace);
}

}  // namespace talkgraph
