#include "nodes/types/phone_chain.h"

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const PhoneChain& c) {
  const StoredModel stored("chain of phones");
  stored.sorted("phones", c.phones);
  stored.matrix("start", c.start, c.size(), 1);
  stored.weights("start", c.start);
  stored.matrix("transitions", c.transitions, c.size(), c.size());
  stored.weights("transitions", c.transitions);
}

}  // namespace

void fields(Archive& ar, PhoneChain& c) {
  ar("phones", c.phones);
  ar("start", c.start);
  ar("transitions", c.transitions);
  if (ar.loading()) check(c);
}

}  // namespace talkgraph
