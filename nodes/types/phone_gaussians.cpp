#include "nodes/types/phone_gaussians.h"

namespace talkgraph {

void fields(Archive& ar, PhoneGaussians& g) {
  ar("phones", g.phones);
  ar("means", g.means);
  ar("variances", g.variances);
  ar("smoothness", g.smoothness);
  ar("order", g.order);
  ar("scaling", g.scaling);
  ar("trace", g.trace);
}

}  // namespace talkgraph
