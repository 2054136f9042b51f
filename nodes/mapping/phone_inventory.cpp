#include "nodes/mapping/phone_inventory.h"

#include <algorithm>

namespace talkgraph {

std::vector<std::string> phone_inventory(std::vector<std::string> labels) {
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels;
}

Eigen::Index place_of(const std::vector<std::string>& inventory, const std::string& phone) {
  const auto found = std::lower_bound(inventory.begin(), inventory.end(), phone);
  return found != inventory.end() && *found == phone ? found - inventory.begin() : std::ssize(inventory);
}

}  // namespace talkgraph
