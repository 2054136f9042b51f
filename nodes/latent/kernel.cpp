#include "nodes/latent/kernel.h"

#include <cmath>

namespace talkgraph {

namespace {

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;

Eigen::Index count(const KernelTerm& term) { return std::holds_alternative<RbfTerm>(term) ? 2 : 1; }

/// Calls f(term, index of its first log parameter) for every term.
template <class K, class F>
void each(K& kernel, F f) {
  Eigen::Index at = 0;
  for (auto& term : kernel.terms) {
    std::visit([&](auto& t) { f(t, at); }, term);
    at += count(term);
  }
}

}  // namespace

Eigen::Index parameter_count(const Kernel& kernel) {
  Eigen::Index n = 0;
  for (const auto& term : kernel.terms) n += count(term);
  return n;
}

std::vector<std::string> parameter_names(const Kernel& kernel) {
  std::vector<std::string> names;
  each(kernel, Overload{[&](const RbfTerm&, Eigen::Index) {
                          names.push_back("rbf_variance");
                          names.push_back("inverse_width");
                        },
                        [&](const LinearTerm&, Eigen::Index) { names.push_back("linear"); },
                        [&](const BiasTerm&, Eigen::Index) { names.push_back("bias"); },
                        [&](const WhiteTerm&, Eigen::Index) { names.push_back("white"); }});
  return names;
}

Eigen::VectorXd log_parameters(const Kernel& kernel) {
  Eigen::VectorXd logs(parameter_count(kernel));
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index i) {
                          logs[i] = std::log(t.variance);
                          logs[i + 1] = std::log(t.inverse_width);
                        },
                        [&](const WhiteTerm& t, Eigen::Index i) { logs[i] = std::log(t.variance - t.floor); },
                        [&](const auto& t, Eigen::Index i) { logs[i] = std::log(t.variance); }});
  return logs;
}

void set_log_parameters(Kernel& kernel, const Eigen::Ref<const Eigen::VectorXd>& logs) {
  each(kernel, Overload{[&](RbfTerm& t, Eigen::Index i) {
                          t.variance = std::exp(logs[i]);
                          t.inverse_width = std::exp(logs[i + 1]);
                        },
                        [&](WhiteTerm& t, Eigen::Index i) { t.variance = t.floor + std::exp(logs[i]); },
                        [&](auto& t, Eigen::Index i) { t.variance = std::exp(logs[i]); }});
}

double white_variance(const Kernel& kernel) {
  double sum = 0;
  each(kernel,
       Overload{[&](const WhiteTerm& t, Eigen::Index) { sum += t.variance; }, [](const auto&, Eigen::Index) {}});
  return sum;
}

void white_gradient(const Kernel& kernel, double derivative, VectorView logs) {
  each(kernel, Overload{[&](const WhiteTerm& t, Eigen::Index i) { logs[i] += derivative * (t.variance - t.floor); },
                        [](const auto&, Eigen::Index) {}});
}

void diagonal(const Kernel& kernel, const ConstMatrix& x, VectorView values) {
  values.setZero();
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index) { values.array() += t.variance; },
                        [&](const LinearTerm& t, Eigen::Index) { values += t.variance * x.rowwise().squaredNorm(); },
                        [&](const BiasTerm& t, Eigen::Index) { values.array() += t.variance; },
                        [](const WhiteTerm&, Eigen::Index) {}});
}

void diagonal_gradient(const Kernel& kernel, const ConstMatrix& x, const Eigen::Ref<const Eigen::VectorXd>& g,
                       MatrixView x_gradient, VectorView logs) {
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index i) { logs[i] += t.variance * g.sum(); },
                        [&](const LinearTerm& t, Eigen::Index i) {
                          logs[i] += t.variance * g.dot(x.rowwise().squaredNorm());
                          for (Eigen::Index c = 0; c < x.cols(); ++c)
                            x_gradient.col(c).array() += 2 * t.variance * g.array() * x.col(c).array();
                        },
                        [&](const BiasTerm& t, Eigen::Index i) { logs[i] += t.variance * g.sum(); },
                        [](const WhiteTerm&, Eigen::Index) {}});
}

const Eigen::MatrixXd& KernelMatrix::compute(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b) {
  value_.setZero(a.rows(), b.rows());
  a_norm_ = a.rowwise().squaredNorm();
  b_norm_ = b.rowwise().squaredNorm();
  product_.resize(a.rows(), b.rows());
  product_.noalias() = a * b.transpose();
  rbf_.resize(kernel.terms.size());
  std::size_t index = 0;
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index) {
                          Eigen::MatrixXd& k = rbf_[index++];
                          k.resize(a.rows(), b.rows());
                          for (Eigen::Index j = 0; j < b.rows(); ++j)
                            k.col(j) =
                                t.variance * (-0.5 * t.inverse_width *
                                              (a_norm_.array() + b_norm_[j] - 2 * product_.col(j).array()).max(0.0))
                                                 .exp();
                          value_ += k;
                        },
                        [&](const LinearTerm& t, Eigen::Index) { value_ += t.variance * product_; },
                        [&](const BiasTerm& t, Eigen::Index) { value_.array() += t.variance; },
                        [](const WhiteTerm&, Eigen::Index) {}});
  return value_;
}

void KernelMatrix::gradient(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b, const ConstMatrix& g,
                            MatrixView a_gradient, MatrixView b_gradient, VectorView logs) {
  a_sum_.resize(a.rows(), a.cols());
  b_sum_.resize(b.rows(), b.cols());
  const auto add_rbf = [&](const RbfTerm& t, const Eigen::MatrixXd& k, Eigen::Index i) {
    product_ = g.cwiseProduct(k);
    a_total_ = product_.rowwise().sum();
    b_total_ = product_.colwise().sum().transpose();
    a_sum_.noalias() = product_ * b;
    b_sum_.noalias() = product_.transpose() * a;
    const double squares = a_total_.dot(a_norm_) + b_total_.dot(b_norm_) - 2 * a_sum_.cwiseProduct(a).sum();
    logs[i] += a_total_.sum();
    logs[i + 1] -= 0.5 * t.inverse_width * squares;
    for (Eigen::Index c = 0; c < a.cols(); ++c) {
      a_gradient.col(c) += t.inverse_width * (a_sum_.col(c) - a_total_.cwiseProduct(a.col(c)));
      b_gradient.col(c) += t.inverse_width * (b_sum_.col(c) - b_total_.cwiseProduct(b.col(c)));
    }
  };
  std::size_t index = 0;
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index i) { add_rbf(t, rbf_[index++], i); },
                        [&](const LinearTerm& t, Eigen::Index i) {
                          a_sum_.noalias() = g * b;
                          b_sum_.noalias() = g.transpose() * a;
                          logs[i] += t.variance * a_sum_.cwiseProduct(a).sum();
                          a_gradient += t.variance * a_sum_;
                          b_gradient += t.variance * b_sum_;
                        },
                        [&](const BiasTerm& t, Eigen::Index i) { logs[i] += t.variance * g.sum(); },
                        [](const WhiteTerm&, Eigen::Index) {}});
}

}  // namespace talkgraph
