#pragma once

#include <map>
#include <string>

#include "nodes/types/lds.h"
#include "nodes/types/phone_chain.h"
#include "nodes/types/scaling.h"

namespace talkgraph {

/// A switching linear dynamical system with phones as states (Eqns 5.1-5.6). Its frames are scaled, those of the face
/// or of sound and face side by side, audio first, with noises that are independent of each other.
struct Slds {
  Scaling audio, visual;              ///< audio of no dimensions if the system gives the face alone
  std::map<std::string, Lds> phones;  ///< the system of each
  Lds shared;                         ///< of all phones together, for those that are not there
  PhoneChain chain;                   ///< of all phones of training, also those without a system of their own
  std::vector<double> trace;  ///< log-likelihood of the training sequences at the start and after each iteration
};
template <>
inline constexpr PortType port_type<Slds>{"Slds", 2};
void fields(Archive& ar, Slds& s);

}  // namespace talkgraph
