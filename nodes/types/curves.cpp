#include "nodes/types/curves.h"

#include <stdexcept>

namespace talkgraph {

void fields(Archive& ar, Curves& c) {
  ar("keys", c.keys);
  ar("curves", c.curves);
  if (ar.loading() && c.keys.size() != c.curves.size())
    throw std::runtime_error("curves: as many keys as curves are needed");
}

}  // namespace talkgraph
