#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace talkgraph {

/// The phones that occur, sorted, each once.
std::vector<std::string> phone_inventory(std::vector<std::string> labels);

/// The place of a phone in an inventory, or the inventory's size if it is not there.
Eigen::Index place_of(const std::vector<std::string>& inventory, const std::string& phone);

}  // namespace talkgraph
