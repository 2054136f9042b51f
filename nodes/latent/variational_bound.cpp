#include "nodes/latent/variational_bound.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace talkgraph {

namespace {

Eigen::MatrixXd outputs_of(const Eigen::MatrixXd& all, const RowStatistics::Group& group) {
  return all(Eigen::all, group.outputs);
}

double log_normaliser(const RowStatistics::Group& group, const InducingVariables& u) {
  return -0.5 * group.rows * static_cast<double>(group.outputs.size()) * std::log(2 * std::numbers::pi / u.precision());
}

void begin(BoundGradient& g, const InducingVariables& u, const RowStatistics& rows) {
  g.projected.setZero(u.count(), rows.projected.cols());
  g.psi2.resize(rows.groups.size());
  g.inducing.setZero(u.count(), u.count());
  g.diagonal = 0;
  g.noise = 0;
}

}  // namespace

void InducingVariables::begin(const Eigen::MatrixXd& covariance, double diagonal, double noise) {
  cholesky_.compute(covariance, base_jitter_, "the covariance of the inducing points");
  diagonal_ = diagonal;
  noise_ = noise;
}

Eigen::MatrixXd InducingVariables::whitened(Eigen::MatrixXd a) const {
  cholesky_.factor().triangularView<Eigen::Lower>().solveInPlace(a);
  return a;
}

Eigen::MatrixXd InducingVariables::unwhitened(Eigen::MatrixXd a) const {
  cholesky_.factor().transpose().triangularView<Eigen::Upper>().solveInPlace(a);
  return a;
}

Eigen::MatrixXd InducingVariables::whitened_square(const Eigen::MatrixXd& a) const {
  const Eigen::MatrixXd b = whitened(whitened(a).transpose());
  return 0.5 * (b + b.transpose());
}

Eigen::MatrixXd InducingVariables::unwhitened_square(const Eigen::MatrixXd& a) const {
  const Eigen::MatrixXd b = unwhitened(unwhitened(a).transpose());
  return 0.5 * (b + b.transpose());
}

// With T = L⁻¹Ψ2L⁻ᵀ, A = I + βT, c = A^−½L⁻¹Ψ1ᵀY of the n rows and D outputs of a group, the bound is
//   −½nD ln(2π/β) − ½β|Y|² + ½β²|c|² − ½D ln|A| − ½βD(n k(x, x) − tr T).
void CollapsedBound::factorise(const InducingVariables& u, const RowStatistics& rows,
                               const RowStatistics::Group& group) {
  second_ = u.whitened_square(group.psi2);
  a_ = u.precision() * second_;
  a_.diagonal().array() += 1;
  inner_.compute(a_, 0, "the inner matrix of the variational bound");
  projected_ = u.whitened(outputs_of(rows.projected, group));
  c_ = projected_;
  inner_.factor().triangularView<Eigen::Lower>().solveInPlace(c_);
}

double CollapsedBound::evaluate(const InducingVariables& u, const RowStatistics& rows, BoundGradient* gradient) {
  const double beta = u.precision();
  const Eigen::Index m = u.count();
  double value = -0.5 * beta * rows.squares;
  double by_precision = -0.5 * rows.squares;
  if (gradient) begin(*gradient, u, rows);
  for (std::size_t i = 0; i < rows.groups.size(); ++i) {
    const auto& group = rows.groups[i];
    factorise(u, rows, group);
    const double outputs = static_cast<double>(group.outputs.size());
    const double left = group.rows * u.diagonal() - second_.trace();
    value += log_normaliser(group, u) +
             0.5 * (beta * beta * c_.squaredNorm() - outputs * (inner_.log_determinant() + beta * left));
    if (!gradient) continue;

    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(m, m);
    inner_.factor().triangularView<Eigen::Lower>().solveInPlace(inverse);
    inverse = (inverse.transpose() * inverse).eval();
    Eigen::MatrixXd weights = beta * c_;
    inner_.factor().transpose().triangularView<Eigen::Upper>().solveInPlace(weights);
    const Eigen::MatrixXd outer = weights * weights.transpose();
    const Eigen::MatrixXd gained = outputs * (Eigen::MatrixXd::Identity(m, m) - inverse);
    gradient->projected(Eigen::all, group.outputs) = beta * u.unwhitened(weights);
    gradient->psi2[i] = u.unwhitened_square(0.5 * beta * (gained - outer));
    gradient->inducing += u.unwhitened_square(0.5 * (gained - outer - beta * outputs * second_));
    gradient->diagonal -= 0.5 * beta * outputs * group.rows;
    by_precision += 0.5 * (group.rows * outputs / beta - outputs * left) + beta * c_.squaredNorm() -
                    0.5 * (second_.cwiseProduct(outer).sum() + outputs * inverse.cwiseProduct(second_).sum());
  }
  if (gradient) {
    gradient->noise = -beta * beta * by_precision;
    u.add_jitter_gradient(gradient->inducing);
  }
  return value;
}

Eigen::MatrixXd CollapsedBound::weights(const InducingVariables& u, const RowStatistics& rows) {
  Eigen::MatrixXd all(u.count(), rows.projected.cols());
  for (const auto& group : rows.groups) {
    factorise(u, rows, group);
    inner_.factor().transpose().triangularView<Eigen::Upper>().solveInPlace(c_);
    all(Eigen::all, group.outputs) = u.precision() * u.unwhitened(c_);
  }
  return all;
}

Eigen::MatrixXd CollapsedBound::reduction(const InducingVariables& u, const RowStatistics& rows) {
  const Eigen::Index m = u.count();
  const double outputs = static_cast<double>(rows.projected.cols());
  Eigen::MatrixXd mean = Eigen::MatrixXd::Identity(m, m);
  for (const auto& group : rows.groups) {
    factorise(u, rows, group);
    Eigen::MatrixXd root = Eigen::MatrixXd::Identity(m, m);
    inner_.factor().triangularView<Eigen::Lower>().solveInPlace(root);
    mean.noalias() -= static_cast<double>(group.outputs.size()) / outputs * root.transpose() * root;
  }
  return u.unwhitened_square(mean);
}

// Mean and variance follow from the precision at the next move().
void fields(Archive& ar, StochasticBound& bound) {
  std::vector<Eigen::MatrixXd> precisions, precision_means;
  for (const auto& q : bound.posteriors_) {
    precisions.push_back(q.precision);
    precision_means.push_back(q.precision_mean);
  }
  ar("precisions", precisions);
  ar("precision_means", precision_means);
  if (!ar.loading()) return;
  bound.posteriors_.resize(precisions.size());
  for (std::size_t i = 0; i < precisions.size(); ++i) {
    bound.posteriors_[i].precision = precisions[i];
    bound.posteriors_[i].precision_mean = precision_means.at(i);
  }
}

void StochasticBound::move(const InducingVariables& u, const RowStatistics& rows, double scale, double step) {
  const Eigen::Index m = u.count();
  const double weight = step * scale * u.precision();
  posteriors_.resize(rows.groups.size());
  for (std::size_t i = 0; i < rows.groups.size(); ++i) {
    const auto& group = rows.groups[i];
    Posterior& q = posteriors_[i];
    if (q.precision.size() == 0) {
      q.precision.setIdentity(m, m);
      q.precision_mean.setZero(m, static_cast<Eigen::Index>(group.outputs.size()));
    }
    q.precision = (1 - step) * q.precision + weight * u.whitened_square(group.psi2);
    q.precision.diagonal().array() += step;
    q.precision_mean = (1 - step) * q.precision_mean + weight * u.whitened(outputs_of(rows.projected, group));
    Cholesky factor;
    factor.compute(q.precision, 0, "the precision of the inducing variables");
    q.log_determinant = factor.log_determinant();
    q.variance.setIdentity(m, m);
    factor.factor().triangularView<Eigen::Lower>().solveInPlace(q.variance);
    q.variance = (q.variance.transpose() * q.variance).eval();
    q.mean = q.variance * q.precision_mean;
  }
}

// With v ~ N(m, S), R = m mᵀ + D·S and p = L⁻¹Ψ1ᵀY the terms of the rows of a group are
//   −½nD ln(2π/β) − ½β|Y|² + β tr(mᵀp) − ½β tr(TR) − ½βD(n k(x, x) − tr T).
// As a function of L they change by −L⁻ᵀH, H = βm pᵀ + βT-terms, whose derivative by k(U, U) is that of a Cholesky
// factor (Murray 2016): L⁻ᵀ Φ(−H) L⁻¹, Φ the lower triangle with half its diagonal, made symmetric.
double StochasticBound::evaluate(const InducingVariables& u, const RowStatistics& rows, double scale,
                                 BoundGradient* gradient) {
  const double beta = u.precision();
  const Eigen::Index m = u.count();
  double value = -0.5 * scale * beta * rows.squares;
  double by_precision = -0.5 * rows.squares;
  if (gradient) begin(*gradient, u, rows);
  for (std::size_t i = 0; i < rows.groups.size(); ++i) {
    const auto& group = rows.groups[i];
    const Posterior& q = posteriors_[i];
    const double outputs = static_cast<double>(group.outputs.size());
    const Eigen::MatrixXd second = u.whitened_square(group.psi2);
    const Eigen::MatrixXd projected = u.whitened(outputs_of(rows.projected, group));
    const Eigen::MatrixXd square = q.mean * q.mean.transpose() + outputs * q.variance;
    const double explained = q.mean.cwiseProduct(projected).sum() - 0.5 * second.cwiseProduct(square).sum();
    const double left = group.rows * u.diagonal() - second.trace();
    value += scale * (log_normaliser(group, u) + beta * (explained - 0.5 * outputs * left));
    value -= 0.5 * (outputs * (q.variance.trace() - static_cast<double>(m) + q.log_determinant) + q.mean.squaredNorm());
    if (!gradient) continue;

    const double weight = scale * beta;
    Eigen::MatrixXd by_second = -0.5 * weight * square;
    by_second.diagonal().array() += 0.5 * weight * outputs;
    gradient->projected(Eigen::all, group.outputs) = weight * u.unwhitened(q.mean);
    gradient->psi2[i] = u.unwhitened_square(by_second);
    Eigen::MatrixXd by_root =
        (-weight * q.mean * projected.transpose() - 2 * by_second * second).triangularView<Eigen::Lower>();
    by_root.diagonal() *= 0.5;
    gradient->inducing += u.unwhitened_square(0.5 * (by_root + by_root.transpose()));
    gradient->diagonal -= 0.5 * weight * outputs * group.rows;
    by_precision += 0.5 * group.rows * outputs / beta + explained - 0.5 * outputs * left;
  }
  if (gradient) {
    gradient->noise = -scale * beta * beta * by_precision;
    u.add_jitter_gradient(gradient->inducing);
  }
  return value;
}

}  // namespace talkgraph
