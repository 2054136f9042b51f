#include "nodes/types/sgpdm.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "nodes/types/gpdm.h"
#include "nodes/types/pile.h"
#include "nodes/types/ssgpdm.h"
#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

/// A term as it is stored: numbers that its kind does not have are zero.
struct StoredTerm {
  std::string kind;
  double variance = 0;
  std::vector<double> inverse_widths;  // of "rbf" one, of "ard" one a dimension
  double floor = 0;
};

StoredTerm stored(const RbfTerm& t) { return {"rbf", t.variance, {t.inverse_width}}; }
StoredTerm stored(const ArdTerm& t) { return {"ard", t.variance, {t.inverse_widths.begin(), t.inverse_widths.end()}}; }
StoredTerm stored(const LinearTerm& t) { return {"linear", t.variance, {}}; }
StoredTerm stored(const BiasTerm& t) { return {"bias", t.variance, {}}; }
StoredTerm stored(const WhiteTerm& t) { return {"white", t.variance, {}, t.floor}; }

KernelTerm restored(const StoredTerm& t) {
  const auto& widths = t.inverse_widths;
  if (t.kind == "rbf" && widths.size() == 1) return RbfTerm{t.variance, widths[0]};
  if (t.kind == "ard")
    return ArdTerm{t.variance, Eigen::VectorXd::Map(widths.data(), static_cast<Eigen::Index>(widths.size()))};
  if (t.kind == "linear") return LinearTerm{t.variance};
  if (t.kind == "bias") return BiasTerm{t.variance};
  if (t.kind == "white") return WhiteTerm{t.variance, t.floor};
  throw std::runtime_error("unknown kernel term \"" + t.kind + "\" in a stored model; train it anew");
}

}  // namespace

void fields(Archive& ar, HiddenUnits& u) {
  ar("weights", u.weights);
  ar("bias", u.bias);
}

void fields(Archive& ar, RbfUnits& u) {
  ar("centres", u.centres);
  ar("inverse_widths", u.inverse_widths);
}

/// One entry a term; the inverse widths of all terms stand one after another, `widths` of them a term.
void fields(Archive& ar, Kernel& k) {
  std::vector<std::string> kinds;
  std::vector<double> variances, inverse_widths, floors;
  std::vector<std::int64_t> widths;
  for (const auto& term : k.terms) {
    const StoredTerm s = std::visit([](const auto& t) { return stored(t); }, term);
    kinds.push_back(s.kind);
    variances.push_back(s.variance);
    widths.push_back(static_cast<std::int64_t>(s.inverse_widths.size()));
    inverse_widths.insert(inverse_widths.end(), s.inverse_widths.begin(), s.inverse_widths.end());
    floors.push_back(s.floor);
  }
  ar("kinds", kinds);
  ar("variances", variances);
  ar("widths", widths);
  ar("inverse_widths", inverse_widths);
  ar("floors", floors);
  if (!ar.loading()) return;
  const std::size_t terms = kinds.size();
  if (variances.size() != terms || widths.size() != terms || floors.size() != terms)
    throw std::runtime_error("a stored kernel has " + std::to_string(terms) + " terms but not as many values");
  k.terms.clear();
  std::size_t at = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    const auto count = static_cast<std::size_t>(widths[i]);
    if (widths[i] < 0 || count > inverse_widths.size() - at)
      throw std::runtime_error("a stored kernel has fewer inverse widths than its terms say");
    const auto first = inverse_widths.begin() + static_cast<std::ptrdiff_t>(at);
    k.terms.push_back(
        restored({kinds[i], variances[i], {first, first + static_cast<std::ptrdiff_t>(count)}, floors[i]}));
    at += count;
  }
}

namespace {

/// The rows of a lower triangle, one after the other.
std::vector<double> triangle_of(const Eigen::MatrixXd& root) {
  std::vector<double> rows;
  for (Eigen::Index i = 0; i < root.rows(); ++i)
    rows.insert(rows.end(), root.row(i).begin(), root.row(i).begin() + i + 1);
  return rows;
}

Eigen::MatrixXd from_triangle(const std::vector<double>& rows) {
  const auto k = std::lround((std::sqrt(8.0 * static_cast<double>(rows.size()) + 1) - 1) / 2);
  if (k * (k + 1) / 2 != static_cast<Eigen::Index>(rows.size()))
    throw std::runtime_error("a stored triangle has " + std::to_string(rows.size()) + " entries; train the model anew");
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(k, k);
  auto at = rows.begin();
  for (Eigen::Index i = 0; i < k; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) root(i, j) = *at++;
  return root;
}

/// All but the basis. Of a triangular root the triangle is kept.
void prediction_fields(Archive& ar, GaussianProcess& g) {
  ar("kernel", g.kernel);
  ar("weights", g.weights);
  ar("reduction", g.reduction);
  std::optional<Eigen::MatrixXd> root;
  std::optional<std::vector<double>> triangle;
  if (!ar.loading() && g.root.rows() == g.root.cols() && g.root.isLowerTriangular(0))
    triangle = triangle_of(g.root);
  else if (!ar.loading())
    root = g.root;
  ar("root", root);
  ar("triangle", triangle);
  if (ar.loading()) g.root = triangle ? from_triangle(*triangle) : root.value_or(Eigen::MatrixXd());
  ar("mean", g.mean);
  ar("scale", g.scale);
}

/// A process of a model whose latent points are `inputs`; a basis that is those is not kept again.
struct ProcessOfModel {
  GaussianProcess& process;
  const Eigen::MatrixXd& inputs;
};
void fields(Archive& ar, ProcessOfModel& p) {
  Eigen::MatrixXd& basis = p.process.basis;
  const bool exact = basis.rows() == p.inputs.rows() && basis.cols() == p.inputs.cols() && basis == p.inputs;
  std::optional<Eigen::MatrixXd> own;
  if (!ar.loading() && !exact) own = basis;
  ar("basis", own);
  if (ar.loading() && own)
    basis = *std::move(own);
  else if (ar.loading())
    basis = p.inputs;
  prediction_fields(ar, p.process);
}

}  // namespace

void fields(Archive& ar, GaussianProcess& g) {
  ar("basis", g.basis);
  prediction_fields(ar, g);
}

void fields(Archive& ar, BackConstraint& b) {
  std::optional<HiddenUnits> hidden;
  std::optional<RbfUnits> rbf;
  if (const auto* units = std::get_if<HiddenUnits>(&b.units)) hidden = *units;
  if (const auto* units = std::get_if<RbfUnits>(&b.units)) rbf = *units;
  ar("hidden", hidden);
  ar("rbf", rbf);
  if (ar.loading() && hidden) b.units = std::move(*hidden);
  if (ar.loading() && rbf) b.units = std::move(*rbf);
  ar("weights", b.weights);
  ar("bias", b.bias);
}

namespace {

void check_back_constraint(const StoredModel& stored, const BackConstraint& b, Eigen::Index inputs, Eigen::Index d) {
  const std::string name = "back_constraint";
  if (const auto* hidden = std::get_if<HiddenUnits>(&b.units)) {
    stored.matrix(name + ".hidden.weights", hidden->weights, inputs, b.weights.rows());
    stored.matrix(name + ".hidden.bias", hidden->bias, 1, b.weights.rows());
  } else {
    const auto& rbf = std::get<RbfUnits>(b.units);
    stored.matrix(name + ".rbf.centres", rbf.centres, b.weights.rows(), inputs);
    stored.matrix(name + ".rbf.inverse_widths", rbf.inverse_widths, 1, inputs);
  }
  stored.matrix(name + ".weights", b.weights, b.weights.rows(), d);
  stored.matrix(name + ".bias", b.bias, 1, d);
}

/// What models of one and of two streams have in common; the back-constraint is of the stream that `first` makes.
template <class Model>
void check_latents(const StoredModel& stored, const Model& m, const GaussianProcess& first) {
  const Eigen::Index n = m.latents.rows(), d = m.latents.cols();
  stored.matrix("latents", m.latents, n, d);
  stored.require(n > 0 && d > 0, "latents", "is empty");
  const bool some = std::all_of(m.lengths.begin(), m.lengths.end(), [&](auto l) { return l > 0 && l <= n; });
  stored.require(some && std::accumulate(m.lengths.begin(), m.lengths.end(), std::int64_t{0}) == n, "lengths",
                 "do not sum to the number of latent points");
  stored.require(m.form >= DynamicsForm::absolute && m.form <= DynamicsForm::phase, "form", "is unknown");
  if (m.dynamics) stored.process("dynamics", *m.dynamics, is_timed(m.form) ? 1 : d, d);
  if (m.back_constraint) check_back_constraint(stored, *m.back_constraint, first.mean.size(), d);
  stored.not_negative("dynamics_bias", m.dynamics_bias);
  stored.positive("first_variance", m.first_variance);
}

void check(const Sgpdm& s) {
  const StoredModel stored("state \"" + s.label + "\"");
  check_latents(stored, s, s.audio);
  stored.matrix("audio_frames", s.audio_frames, s.latents.rows(), s.audio.mean.size());
  stored.process("audio", s.audio, s.latents.cols(), s.audio.mean.size());
  stored.process("visual", s.visual, s.latents.cols(), s.visual.mean.size());
}

void check(const Gpdm& g) {
  const StoredModel stored("GPDM");
  check_latents(stored, g, g.observations);
  stored.process("observations", g.observations, g.latents.cols(), g.observations.mean.size());
}

void check(const Ssgpdm& s) {
  for (const auto& [phone, label] : s.ending)
    StoredModel("switching model").require(s.states.contains(label), "ending_labels", "names no state: " + label);
  for (const auto& [label, state] : s.states) {
    const StoredModel stored("state \"" + label + "\"");
    const Sgpdm& first = s.states.begin()->second;
    stored.matrix("audio.mean", state.audio.mean, 1, first.audio.mean.size());
    stored.matrix("visual.mean", state.visual.mean, 1, first.visual.mean.size());
  }
}

}  // namespace

void fields(Archive& ar, Sgpdm& s) {
  ar("label", s.label);
  ar("latents", s.latents);
  ar("lengths", s.lengths);
  ar("audio_frames", s.audio_frames);
  ProcessOfModel audio{s.audio, s.latents}, visual{s.visual, s.latents};
  ar("audio", audio);
  ar("visual", visual);
  ar("dynamics", s.dynamics);
  ar("form", s.form);
  ar("back_constraint", s.back_constraint);
  ar("dynamics_bias", s.dynamics_bias);
  ar("first_variance", s.first_variance);
  ar("log_likelihood", s.log_likelihood);
  ar("iterations", s.iterations);
  ar("jitter", s.jitter);
  ar("trace", s.trace);
  ar("ended", s.ended);
  if (ar.loading()) check(s);
}

void fields(Archive& ar, Gpdm& g) {
  ar("latents", g.latents);
  ar("lengths", g.lengths);
  ar("names", g.names);
  ProcessOfModel observations{g.observations, g.latents};
  ar("observations", observations);
  ar("dynamics", g.dynamics);
  ar("form", g.form);
  ar("back_constraint", g.back_constraint);
  ar("dynamics_bias", g.dynamics_bias);
  ar("first_variance", g.first_variance);
  ar("log_likelihood", g.log_likelihood);
  ar("jitter", g.jitter);
  ar("trace", g.trace);
  ar("ended", g.ended);
  if (ar.loading()) check(g);
}

void fields(Archive& ar, Ssgpdm& s) {
  std::size_t size = s.states.size();
  std::vector<Sgpdm> loaded;
  auto state = s.states.begin();
  Pile::keep(ar, "states", size, [&](Archive& pile, std::size_t) {
    fields(pile, ar.loading() ? loaded.emplace_back() : (state++)->second);
  });
  std::vector<std::string> phones, labels;
  for (const auto& [phone, label] : s.ending) {
    phones.push_back(phone);
    labels.push_back(label);
  }
  ar("ending_phones", phones);
  ar("ending_labels", labels);
  if (!ar.loading()) return;
  s.states.clear();
  for (auto& l : loaded) s.states.emplace(l.label, std::move(l));
  s.ending.clear();
  for (std::size_t i = 0; i < phones.size() && i < labels.size(); ++i) s.ending[phones[i]] = labels[i];
  check(s);
}

}  // namespace talkgraph
