#include "nodes/mapping/ssgpdm.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "nodes/types/vlmm.h"

namespace talkgraph {

Ssgpdm AssembleSsgpdm::operator()(const Collected<Sgpdm>& states) const {
  if (states.empty()) throw std::runtime_error("no trained states: the training set made no windows");
  Ssgpdm model;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Sgpdm& s = states[i];
    if (s.audio.mean.size() != states[0].audio.mean.size() || s.visual.mean.size() != states[0].visual.mean.size())
      throw std::runtime_error(fmt::format(
          "state \"{}\" has {} audio and {} visual dimensions, state \"{}\" {} and {}: train all on the same features",
          s.label, s.audio.mean.size(), s.visual.mean.size(), states[0].label, states[0].audio.mean.size(),
          states[0].visual.mean.size()));
    if (!model.states.emplace(s.label, s).second) throw std::runtime_error("two states are called \"" + s.label + "\"");
    auto& ending = model.ending[last_phone(s.label)];
    if (ending.empty() || s.latents.rows() > model.states.at(ending).latents.rows()) ending = s.label;
  }
  return model;
}

const Sgpdm& state_for(const Ssgpdm& model, const std::string& label, const Eigen::RowVectorXd& audio_mean) {
  if (const Sgpdm* state = value_for_label(label, model.states, model.ending)) return *state;
  const Sgpdm* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, state] : model.states) {
    const double distance =
        ((audio_mean - state.audio.mean).array() / state.audio.scale.array()).matrix().squaredNorm();
    if (nearest && distance >= least) continue;
    nearest = &state;
    least = distance;
  }
  return *nearest;
}

void describe(Description<AssembleSsgpdm>& d) {
  d.type("mapping.ssgpdm").version(1);
  d.summary("puts the trained SGPDMs of all states together into one switching model");
  d.source("Thesis §5.1");
  d.input("states", "one trained SGPDM a state").output("model", "the switching model");
}

}  // namespace talkgraph
