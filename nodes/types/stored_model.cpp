#include "nodes/types/stored_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "nodes/types/gmm.h"
#include "nodes/types/scaling.h"
#include "nodes/types/sgpdm.h"

namespace talkgraph {

void StoredModel::require(bool holds, const std::string& member, const std::string& what) const {
  if (holds) return;
  throw std::runtime_error(fmt::format("the stored {} is damaged: its \"{}\" {}; train it anew", name_, member, what));
}

void StoredModel::matrix(const std::string& member, const Eigen::Ref<const Eigen::MatrixXd>& m, Eigen::Index rows,
                         Eigen::Index columns) const {
  if (m.rows() != rows || m.cols() != columns)
    require(false, member,
            fmt::format("is {} × {} where the other members say {} × {}", m.rows(), m.cols(), rows, columns));
  require(m.allFinite(), member, "has a value that is not finite");
}

void StoredModel::covariance(const std::string& member, const Eigen::MatrixXd& m, Eigen::Index n) const {
  matrix(member, m, n, m.cols() == 1 ? 1 : n);
}

void StoredModel::weights(const std::string& member, const Eigen::Ref<const Eigen::MatrixXd>& w) const {
  require(w.allFinite() && w.size() > 0 && w.minCoeff() >= 0 && w.maxCoeff() > 0, member,
          "has values that are no weights");
}

void StoredModel::variances(const std::string& member, const Eigen::MatrixXd& v, Eigen::Index rows,
                            Eigen::Index columns) const {
  matrix(member, v, rows, columns);
  require((v.array() > 0).all(), member, "has a value that is not above 0");
}

void StoredModel::sorted(const std::string& member, const std::vector<std::string>& names) const {
  require(std::adjacent_find(names.begin(), names.end(), std::greater_equal<>()) == names.end(), member,
          "is not sorted");
}

void StoredModel::not_negative(const std::string& member, double value) const {
  require(std::isfinite(value) && value >= 0, member, fmt::format("is {}, and must not be below 0", value));
}

void StoredModel::positive(const std::string& member, double value) const {
  require(std::isfinite(value) && value > 0, member, fmt::format("is {}, and must be above 0", value));
}

void StoredModel::process(const std::string& member, const GaussianProcess& gp, Eigen::Index inputs,
                          Eigen::Index outputs) const {
  const Eigen::Index k = gp.basis.rows();
  matrix(member + ".basis", gp.basis, k, inputs);
  matrix(member + ".weights", gp.weights, k, outputs);
  matrix(member + (gp.root.size() > 0 ? ".root" : ".reduction"), gp.root.size() > 0 ? gp.root : gp.reduction, k, k);
  matrix(member + ".mean", gp.mean, 1, outputs);
  matrix(member + ".scale", gp.scale, 1, outputs);
  require((gp.scale.array() != 0).all(), member + ".scale", "has a value of 0");
  for (const auto& term : gp.kernel.terms) {
    std::visit([&](const auto& t) { not_negative(member + ".kernel.variances", t.variance); }, term);
    const std::string widths = member + ".kernel.inverse_widths";
    if (const auto* rbf = std::get_if<RbfTerm>(&term)) not_negative(widths, rbf->inverse_width);
    const auto* ard = std::get_if<ArdTerm>(&term);
    if (!ard) continue;
    matrix(widths, ard->inverse_widths, inputs, 1);
    for (const double width : ard->inverse_widths) not_negative(widths, width);
  }
}

void StoredModel::mixture(const std::string& member, const GaussianMixture& m, Eigen::Index dimension) const {
  matrix(member + ".weights", m.weights, m.components(), 1);
  weights(member + ".weights", m.weights);
  matrix(member + ".means", m.means, m.components(), dimension);
  require(std::ssize(m.covariances) == m.components(), member + ".covariances", "are not one a component");
  for (const auto& c : m.covariances) covariance(member + ".covariances", c, dimension);
}

void StoredModel::mixtures(const std::string& member, const std::vector<GaussianMixture>& of_states,
                           Eigen::Index states, Eigen::Index dimension) const {
  require(std::ssize(of_states) == states, member, "are not one a state");
  for (const auto& m : of_states) mixture(member, m, dimension);
}

void StoredModel::scaling(const std::string& member, const Scaling& scaling, Eigen::Index dimension) const {
  matrix(member + ".mean", scaling.mean, 1, dimension);
  matrix(member + ".deviation", scaling.deviation, 1, dimension);
  require((scaling.deviation.array() >= 0).all(), member + ".deviation", "has a value below 0");
}

}  // namespace talkgraph
