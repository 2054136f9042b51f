#include "nodes/mapping/phone_chain.h"

#include "nodes/mapping/phone_inventory.h"

namespace talkgraph {

PhoneChain phone_chain(const std::vector<std::string>& labels, const std::vector<std::int64_t>& lengths) {
  PhoneChain chain;
  chain.phones = phone_inventory(labels);
  chain.start.setOnes(chain.size());
  chain.transitions.setOnes(chain.size(), chain.size());
  auto label = labels.begin();
  for (const auto length : lengths) {
    Eigen::Index before = place_of(chain.phones, *label++);
    chain.start[before] += 1;
    for (std::int64_t t = 1; t < length; ++t) {
      const Eigen::Index state = place_of(chain.phones, *label++);
      chain.transitions(before, state) += 1;
      before = state;
    }
  }
  chain.start /= chain.start.sum();
  const Eigen::VectorXd sums = chain.transitions.rowwise().sum();
  chain.transitions = sums.cwiseInverse().asDiagonal() * chain.transitions;
  return chain;
}

}  // namespace talkgraph
