#include "nodes/latent/kernel.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "nodes/latent/rbf_loops.h"

namespace talkgraph {

namespace {

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;

Eigen::Index count(const KernelTerm& term) {
  return std::visit(Overload{[](const RbfTerm&) -> Eigen::Index { return 2; },
                             [](const ArdTerm& t) { return 1 + t.inverse_widths.size(); },
                             [](const auto&) -> Eigen::Index { return 1; }},
                    term);
}

/// Calls f(term, index of its first log parameter) for every term.
template <class K, class F>
void each(K& kernel, F f) {
  Eigen::Index at = 0;
  for (auto& term : kernel.terms) {
    std::visit([&](auto& t) { f(t, at); }, term);
    at += count(term);
  }
}

double bias_variance(const Kernel& kernel) {
  double sum = 0;
  each(kernel, Overload{[&](const BiasTerm& t, Eigen::Index) { sum += t.variance; }, [](const auto&, Eigen::Index) {}});
  return sum;
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
                        [&](const ArdTerm& t, Eigen::Index) {
                          names.push_back("ard_variance");
                          for (Eigen::Index c = 1; c <= t.inverse_widths.size(); ++c)
                            names.push_back("inverse_width_" + std::to_string(c));
                        },
                        [&](const LinearTerm&, Eigen::Index) { names.push_back("linear"); },
                        [&](const BiasTerm&, Eigen::Index) { names.push_back("bias"); },
                        [&](const WhiteTerm&, Eigen::Index) { names.push_back("white"); }});
  return names;
}

Eigen::VectorXd without_noise(const Kernel& kernel) {
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(parameter_count(kernel));
  each(kernel, Overload{[&](const WhiteTerm&, Eigen::Index i) { mask[i] = 0; }, [](const auto&, Eigen::Index) {}});
  return mask;
}

Eigen::VectorXd log_parameters(const Kernel& kernel) {
  Eigen::VectorXd logs(parameter_count(kernel));
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index i) {
                          logs[i] = std::log(t.variance);
                          logs[i + 1] = std::log(t.inverse_width);
                        },
                        [&](const ArdTerm& t, Eigen::Index i) {
                          logs[i] = std::log(t.variance);
                          logs.segment(i + 1, t.inverse_widths.size()) = t.inverse_widths.array().log();
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
                        [&](ArdTerm& t, Eigen::Index i) {
                          t.variance = std::exp(logs[i]);
                          t.inverse_widths = logs.segment(i + 1, t.inverse_widths.size()).array().exp();
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
  each(kernel, Overload{[&](const LinearTerm& t, Eigen::Index) {
                          for (Eigen::Index c = 0; c < x.cols(); ++c) values += t.variance * x.col(c).cwiseAbs2();
                        },
                        [](const WhiteTerm&, Eigen::Index) {},
                        [&](const auto& t, Eigen::Index) { values.array() += t.variance; }});
}

void diagonal_gradient(const Kernel& kernel, const ConstMatrix& x, const Eigen::Ref<const Eigen::VectorXd>& g,
                       MatrixView x_gradient, VectorView logs) {
  each(kernel, Overload{[&](const LinearTerm& t, Eigen::Index i) {
                          for (Eigen::Index c = 0; c < x.cols(); ++c) {
                            logs[i] += t.variance * g.dot(x.col(c).cwiseAbs2());
                            x_gradient.col(c).array() += 2 * t.variance * g.array() * x.col(c).array();
                          }
                        },
                        [](const WhiteTerm&, Eigen::Index) {},
                        [&](const auto& t, Eigen::Index i) { logs[i] += t.variance * g.sum(); }});
}

void require_dimension(const Kernel& kernel, Eigen::Index dimension) {
  each(kernel, Overload{[&](const ArdTerm& t, Eigen::Index) {
                          if (t.inverse_widths.size() != dimension)
                            throw std::invalid_argument(
                                fmt::format("an ARD kernel of {} inverse widths, points of {} dimensions",
                                            t.inverse_widths.size(), dimension));
                        },
                        [](const auto&, Eigen::Index) {}});
}

void KernelMatrix::add_rbf(double variance, const ConstMatrix& a, const ConstMatrix& b, Eigen::MatrixXd& values,
                           MatrixView sum) {
  values.resize(a.rows(), b.rows());
  for (Eigen::Index j = 0; j < b.rows(); ++j) {
    point_ = b.row(j);
    rbf::values(variance, widths_.data(), a.cols(), a.data(), a.outerStride(), a.rows(), point_.data(),
                values.col(j).data(), sum.col(j).data());
  }
}

const Eigen::MatrixXd& KernelMatrix::compute(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b) {
  value_.resize(a.rows(), b.rows());
  compute(kernel, a, b, MatrixView(value_));
  return value_;
}

void KernelMatrix::compute(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b, MatrixView value) {
  require_dimension(kernel, a.cols());
  value.setConstant(bias_variance(kernel));
  rbf_.resize(kernel.terms.size());
  std::size_t index = 0;
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index) {
                          widths_.setConstant(a.cols(), t.inverse_width);
                          add_rbf(t.variance, a, b, rbf_[index++], value);
                        },
                        [&](const ArdTerm& t, Eigen::Index) {
                          widths_ = t.inverse_widths;
                          add_rbf(t.variance, a, b, rbf_[index++], value);
                        },
                        [&](const LinearTerm& t, Eigen::Index) { value.noalias() += t.variance * a * b.transpose(); },
                        [](const auto&, Eigen::Index) {}});
}

/// Returns the derivative by the log variance; those by the log inverse widths are −½ · inverse width · squares_.
double KernelMatrix::rbf_gradient(const Eigen::MatrixXd& values, const ConstMatrix& a, const ConstMatrix& b,
                                  const ConstMatrix& g, MatrixView a_gradient, MatrixView b_gradient) {
  const Eigen::Index n = a.rows(), d = a.cols();
  a_sum_.setZero(n, d);
  squares_.setZero(d);
  weights_.resize(n);
  double sum = 0;
  for (Eigen::Index j = 0; j < b.rows(); ++j) {
    point_ = b.row(j);
    total_.setZero(d);
    sum += rbf::pulls(g.col(j).data(), values.col(j).data(), d, a.data(), a.outerStride(), n, point_.data(),
                      weights_.data(), a_sum_.data(), n, total_.data(), squares_.data());
    b_gradient.row(j) += total_.cwiseProduct(widths_.transpose());
  }
  for (Eigen::Index c = 0; c < d; ++c) a_gradient.col(c) -= widths_[c] * a_sum_.col(c);
  return sum;
}

void KernelMatrix::gradient(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b, const ConstMatrix& g,
                            MatrixView a_gradient, MatrixView b_gradient, VectorView logs) {
  std::size_t index = 0;
  each(kernel, Overload{[&](const RbfTerm& t, Eigen::Index i) {
                          widths_.setConstant(a.cols(), t.inverse_width);
                          logs[i] += rbf_gradient(rbf_[index++], a, b, g, a_gradient, b_gradient);
                          logs[i + 1] -= 0.5 * t.inverse_width * squares_.sum();
                        },
                        [&](const ArdTerm& t, Eigen::Index i) {
                          widths_ = t.inverse_widths;
                          logs[i] += rbf_gradient(rbf_[index++], a, b, g, a_gradient, b_gradient);
                          logs.segment(i + 1, widths_.size()) -= 0.5 * widths_.cwiseProduct(squares_);
                        },
                        [&](const LinearTerm& t, Eigen::Index i) {
                          a_sum_.resize(a.rows(), a.cols());
                          b_sum_.resize(b.rows(), b.cols());
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
