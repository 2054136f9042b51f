#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "nodes/types/sgpdm.h"

namespace talkgraph {

/// A switching SGPDM (docs/method.md §5): one SGPDM a state. Labels are phones joined by
/// '-', oldest first.
struct Ssgpdm {
  std::map<std::string, Sgpdm> states;
  std::map<std::string, std::string> ending;  ///< phone -> the state with most frames that ends in it
};
template <>
inline constexpr PortType port_type<Ssgpdm>{"Ssgpdm", 4};
void fields(Archive& ar, Ssgpdm& s);

}  // namespace talkgraph
