#include "nodes/latent/variational_stream.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {

Eigen::VectorXd VariationalProcess::parameters() const {
  const Eigen::Index at = inducing.size();
  Eigen::VectorXd p(size());
  p.head(at) = inducing.reshaped();
  p[at] = std::log(kernel.variance);
  p[at + 1] = std::log(kernel.bias);
  p[at + 2] = std::log(noise - minimum_noise);
  p.tail(inducing.cols()) = kernel.inverse_widths.array().log();
  return p;
}

void VariationalProcess::set(const Eigen::Ref<const Eigen::VectorXd>& p) {
  const Eigen::Index at = inducing.size();
  inducing = p.head(at).reshaped(inducing.rows(), inducing.cols());
  kernel.variance = std::exp(p[at]);
  kernel.bias = std::exp(p[at + 1]);
  noise = minimum_noise + std::exp(p[at + 2]);
  kernel.inverse_widths = p.tail(inducing.cols()).array().exp();
}

VariationalStream::VariationalStream(std::string name, ObservedOutputs outputs, VariationalProcess process)
    : name_(std::move(name)),
      outputs_(std::move(outputs)),
      class_of_(static_cast<std::size_t>(outputs_.rows()), outputs_.classes.size()),
      process_(std::move(process)) {
  for (std::size_t c = 0; c < outputs_.classes.size(); ++c)
    for (const auto row : outputs_.classes[c].rows) class_of_[static_cast<std::size_t>(row)] = c;
}

std::vector<ObservedOutputs::Class> VariationalStream::classes_of(const std::vector<Eigen::Index>& rows) const {
  Classes all(outputs_.classes.size());
  for (std::size_t c = 0; c < all.size(); ++c) all[c].groups = outputs_.classes[c].groups;
  for (const auto row : rows)
    if (const auto c = class_of_[static_cast<std::size_t>(row)]; c < all.size()) all[c].rows.push_back(row);
  std::erase_if(all, [](const auto& c) { return c.rows.empty(); });
  return all;
}

void VariationalStream::begin(const Eigen::Ref<const Eigen::VectorXd>& parameters) {
  process_.set(parameters);
  psi_.begin(process_.kernel, process_.inducing);
  const Eigen::MatrixXd certain = Eigen::MatrixXd::Zero(process_.inducing.rows(), process_.inducing.cols());
  inducing_.begin(psi_.first(process_.inducing, certain), process_.kernel.variance + process_.kernel.bias,
                  process_.noise);
  jitter_ = std::max(jitter_, inducing_.jitter());
}

template <class F>
void VariationalStream::each_part(const Classes& classes, const GaussianRows& q, F f) {
  constexpr Eigen::Index values = 1 << 20;  // of Ψ2 of single rows at a time
  const Eigen::Index m = process_.inducing.rows();
  const Eigen::Index most = std::max<Eigen::Index>(1, 2 * values / (m * (m + 1)));
  for (const auto& c : classes) {
    const auto rows = static_cast<Eigen::Index>(c.rows.size());
    one_part_ = classes.size() == 1 && rows <= most;
    for (Eigen::Index from = 0; from < rows; from += most) {
      const auto begin = c.rows.begin() + from;
      const std::vector<Eigen::Index> part(begin, begin + std::min(most, rows - from));
      part_.mean = q.mean(part, Eigen::all);
      part_.variance = q.variance(part, Eigen::all);
      y_ = outputs_.values(part, Eigen::all);
      f(c, part);
    }
  }
}

void VariationalStream::gather(const Classes& classes, const GaussianRows& q) {
  const Eigen::Index m = process_.inducing.rows();
  statistics_.squares = 0;
  statistics_.projected.setZero(m, outputs_.outputs());
  statistics_.groups.resize(outputs_.groups.size());
  for (std::size_t g = 0; g < outputs_.groups.size(); ++g) {
    statistics_.groups[g].outputs = outputs_.groups[g];
    statistics_.groups[g].rows = 0;
    statistics_.groups[g].psi2.setZero(m, m);
  }
  each_part(classes, q, [&](const ObservedOutputs::Class& c, const std::vector<Eigen::Index>& part) {
    statistics_.squares += y_.squaredNorm();
    statistics_.projected.noalias() += psi_.first(part_.mean, part_.variance).transpose() * y_;
    psi2_.setZero(m, m);
    psi_.add_second(part_.mean, part_.variance, psi2_);
    for (const auto g : c.groups) {
      statistics_.groups[g].rows += static_cast<double>(part.size());
      statistics_.groups[g].psi2 += psi2_;
    }
  });
}

void VariationalStream::chain(const Classes& classes, const GaussianRows& q, GaussianRows& rows,
                              VectorView parameters) {
  const Eigen::Index m = process_.inducing.rows(), d = process_.inducing.cols();
  each_part(classes, q, [&](const ObservedOutputs::Class& c, const std::vector<Eigen::Index>& part) {
    if (!one_part_) {
      psi_.first(part_.mean, part_.variance);
      psi2_.setZero(m, m);
      psi_.add_second(part_.mean, part_.variance, psi2_);
    }
    psi2_.setZero(m, m);
    for (const auto g : c.groups) psi2_ += by_.psi2[g];
    by_psi1_ = y_ * by_.projected.transpose();
    part_gradient_.set_zero(y_.rows(), d);
    psi_.gradient(by_psi1_, psi2_, part_.mean, part_.variance, part_gradient_.mean, part_gradient_.variance);
    rows.mean(part, Eigen::all) += part_gradient_.mean;
    rows.variance(part, Eigen::all) += part_gradient_.variance;
  });

  const Eigen::MatrixXd certain = Eigen::MatrixXd::Zero(m, d);
  part_gradient_.set_zero(m, d);
  psi_.first(process_.inducing, certain);
  psi_.first_gradient(by_.inducing, process_.inducing, certain, part_gradient_.mean, part_gradient_.variance);
  const ArdKernel by_kernel = psi_.kernel_gradient();
  const Eigen::Index at = m * d;
  parameters.head(at) = (part_gradient_.mean + psi_.inducing_gradient()).reshaped();
  parameters[at] = process_.kernel.variance * (by_kernel.variance + by_.diagonal);
  parameters[at + 1] = process_.kernel.bias * (by_kernel.bias + by_.diagonal);
  parameters[at + 2] = (process_.noise - process_.minimum_noise) * by_.noise;
  parameters.tail(d) = process_.kernel.inverse_widths.cwiseProduct(by_kernel.inverse_widths);
}

double VariationalStream::collapsed(const GaussianRows& q, GaussianRows* rows, VectorView parameters) {
  gather(outputs_.classes, q);
  const double value = collapsed_.evaluate(inducing_, statistics_, rows ? &by_ : nullptr);
  if (rows) chain(outputs_.classes, q, *rows, parameters);
  return value;
}

double VariationalStream::stochastic(const Classes& classes, double scale, double step, const GaussianRows& q,
                                     GaussianRows& rows, VectorView parameters) {
  gather(classes, q);
  stochastic_.move(inducing_, statistics_, scale, step);
  const double value = stochastic_.evaluate(inducing_, statistics_, scale, &by_);
  chain(classes, q, rows, parameters);
  return value;
}

GaussianProcess VariationalStream::posterior(const GaussianRows& q) {
  gather(outputs_.classes, q);
  GaussianProcess gp;
  gp.basis = process_.inducing;
  gp.weights = collapsed_.weights(inducing_, statistics_);
  gp.reduction = collapsed_.reduction(inducing_, statistics_);
  gp.mean = outputs_.mean;
  gp.scale = outputs_.scale;
  return gp;
}

}  // namespace talkgraph
