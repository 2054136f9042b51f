#include "nodes/types/slds.h"

#include <algorithm>

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

void check(const Slds& s) {
  const StoredModel stored("switching linear dynamical system");
  const Eigen::Index heard = s.audio.mean.size(), seen = s.visual.mean.size();
  stored.scaling("audio", s.audio, heard);
  stored.scaling("visual", s.visual, seen);
  const auto fits = [&](const Lds& system) {
    return system.dimension() == heard + seen && system.states() == s.shared.states();
  };
  stored.require(fits(s.shared), "shared", "does not give the frames");
  for (const auto& [phone, system] : s.phones) {
    stored.require(fits(system), "phones", "have a system of other sizes: " + phone);
    stored.require(std::ranges::binary_search(s.chain.phones, phone), "chain", "lacks a phone: " + phone);
  }
}

}  // namespace

void fields(Archive& ar, Slds& s) {
  ar("audio", s.audio);
  ar("visual", s.visual);
  ar("phones", s.phones);
  ar("shared", s.shared);
  ar("chain", s.chain);
  ar("trace", s.trace);
  if (ar.loading()) check(s);
}

}  // namespace talkgraph
