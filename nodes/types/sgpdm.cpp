#include "nodes/types/sgpdm.h"

#include <stdexcept>

#include "nodes/types/ssgpdm.h"

namespace talkgraph {

namespace {

struct StoredTerm {
  std::string kind;
  double variance = 0, other = 0;
};

StoredTerm stored(const RbfTerm& t) { return {"rbf", t.variance, t.inverse_width}; }
StoredTerm stored(const LinearTerm& t) { return {"linear", t.variance, 0}; }
StoredTerm stored(const BiasTerm& t) { return {"bias", t.variance, 0}; }
StoredTerm stored(const WhiteTerm& t) { return {"white", t.variance, t.floor}; }

KernelTerm restored(const StoredTerm& t) {
  if (t.kind == "rbf") return RbfTerm{t.variance, t.other};
  if (t.kind == "linear") return LinearTerm{t.variance};
  if (t.kind == "bias") return BiasTerm{t.variance};
  if (t.kind == "white") return WhiteTerm{t.variance, t.other};
  throw std::runtime_error("unknown kernel term \"" + t.kind + "\" in a stored model; train it anew");
}

}  // namespace

void fields(Archive& ar, Kernel& k) {
  std::vector<std::string> kinds;
  std::vector<double> variances, others;
  for (const auto& term : k.terms) {
    const StoredTerm s = std::visit([](const auto& t) { return stored(t); }, term);
    kinds.push_back(s.kind);
    variances.push_back(s.variance);
    others.push_back(s.other);
  }
  ar("kinds", kinds);
  ar("variances", variances);
  ar("others", others);
  if (!ar.loading()) return;
  if (variances.size() != kinds.size() || others.size() != kinds.size())
    throw std::runtime_error("a stored kernel has " + std::to_string(kinds.size()) + " terms but not as many values");
  k.terms.clear();
  for (std::size_t i = 0; i < kinds.size(); ++i) k.terms.push_back(restored({kinds[i], variances[i], others[i]}));
}

void fields(Archive& ar, GaussianProcess& g) {
  ar("kernel", g.kernel);
  ar("basis", g.basis);
  ar("weights", g.weights);
  ar("reduction", g.reduction);
  ar("mean", g.mean);
  ar("scale", g.scale);
}

void fields(Archive& ar, Sgpdm& s) {
  ar("label", s.label);
  ar("latents", s.latents);
  ar("lengths", s.lengths);
  ar("audio_frames", s.audio_frames);
  ar("audio", s.audio);
  ar("visual", s.visual);
  ar("dynamics", s.dynamics);
  ar("dynamics_bias", s.dynamics_bias);
  ar("first_variance", s.first_variance);
  ar("log_likelihood", s.log_likelihood);
  ar("iterations", s.iterations);
  ar("jitter", s.jitter);
}

void fields(Archive& ar, Ssgpdm& s) {
  ar("states", s.states);
  std::vector<std::string> phones, labels;
  for (const auto& [phone, label] : s.ending) {
    phones.push_back(phone);
    labels.push_back(label);
  }
  ar("ending_phones", phones);
  ar("ending_labels", labels);
  if (!ar.loading()) return;
  s.ending.clear();
  for (std::size_t i = 0; i < phones.size() && i < labels.size(); ++i) s.ending[phones[i]] = labels[i];
}

}  // namespace talkgraph
