#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/objective.h"
#include "tests/nodes/latent/textbook.h"

namespace talkgraph::testing {

/// An approximation beside the dense density that it has to agree with.
struct Approximation {
  std::string name;
  std::function<std::unique_ptr<GpLikelihood>()> make;
  std::function<double(const Kernel&, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u, const Eigen::MatrixXd& y)>
      textbook;
};
/// All of them; PITC has the given blocks.
inline std::vector<Approximation> approximations(const std::vector<Eigen::Index>& blocks) {
  using Matrix = Eigen::MatrixXd;
  return {{"full", [] { return std::make_unique<FullLikelihood>(); },
           [](const Kernel& k, const Matrix& x, const Matrix&, const Matrix& y) {
             return textbook_density(textbook_full(k, x), y);
           }},
          {"DTC", [] { return std::make_unique<DtcLikelihood>(); },
           [](const Kernel& k, const Matrix& x, const Matrix& u, const Matrix& y) {
             return textbook_density(textbook_dtc(k, x, u), y);
           }},
          {"FITC", [] { return std::make_unique<FitcLikelihood>(); },
           [](const Kernel& k, const Matrix& x, const Matrix& u, const Matrix& y) {
             return textbook_density(textbook_fitc(k, x, u), y);
           }},
          {"PITC", [=] { return std::make_unique<PitcLikelihood>(blocks); },
           [=](const Kernel& k, const Matrix& x, const Matrix& u, const Matrix& y) {
             return textbook_density(textbook_pitc(k, x, u, blocks), y);
           }},
          {"variational", [] { return std::make_unique<VariationalLikelihood>(); }, textbook_bound}};
}

/// A kernel sum, and how many inducing points in two dimensions it takes without being singular.
struct NamedKernel {
  std::string name;
  Kernel kernel;
  Eigen::Index inducing = 4;
};
inline std::vector<NamedKernel> kernels() {
  const Eigen::Vector2d widths(0.6, 1.7);
  return {
      {"rbf + white", {{RbfTerm{1.3, 0.7}, WhiteTerm{0.1, 0.02}}}},
      {"ard + white", {{ArdTerm{1.3, widths}, WhiteTerm{0.1}}}},
      {"linear + white", {{LinearTerm{0.8}, WhiteTerm{0.2, 0.01}}}, 2},
      {"bias + white", {{BiasTerm{0.5}, WhiteTerm{0.2}}}, 1},
      {"rbf + bias + white", {{RbfTerm{1.3, 0.7}, BiasTerm{0.2}, WhiteTerm{0.1, 0.02}}}},
      {"rbf + linear + white", {{RbfTerm{0.4, 2}, LinearTerm{0.8}, WhiteTerm{0.05, 0.001}}}},
      {"ard + linear + bias + white", {{ArdTerm{0.9, widths}, LinearTerm{0.3}, BiasTerm{0.1}, WhiteTerm{0.1}}}},
      {"rbf + ard + white + white", {{RbfTerm{0.4, 2}, ArdTerm{0.9, widths}, WhiteTerm{0.1, 0.05}, WhiteTerm{0.05}}}}};
}

/// A likelihood as a function of X, U, Y and the log parameters.
class LikelihoodCost : public Objective {
 public:
  LikelihoodCost(GpLikelihood& likelihood, Kernel kernel, Eigen::Index n, Eigen::Index d, Eigen::Index k,
                 Eigen::Index outputs)
      : likelihood_(likelihood), kernel_(std::move(kernel)), x_(n, d), u_(k, d), y_(n, outputs) {}

  Eigen::Index size() const override { return x_.size() + u_.size() + y_.size() + parameter_count(kernel_); }
  bool evaluate(const Eigen::VectorXd& p, double& cost, Eigen::VectorXd* gradient) override {
    x_ = p.head(x_.size()).reshaped(x_.rows(), x_.cols());
    u_ = p.segment(x_.size(), u_.size()).reshaped(u_.rows(), u_.cols());
    y_ = p.segment(x_.size() + u_.size(), y_.size()).reshaped(y_.rows(), y_.cols());
    set_log_parameters(kernel_, p.tail(parameter_count(kernel_)));
    g_.set_zero(x_.rows(), u_.rows(), x_.cols(), parameter_count(kernel_));
    cost = likelihood_.evaluate(kernel_, x_, u_, y_, gradient ? &g_ : nullptr);
    if (!gradient) return true;
    gradient->resize(size());
    *gradient << g_.inputs.reshaped(), g_.inducing.reshaped(), g_.outputs.reshaped(), g_.kernel;
    return true;
  }
  std::string name(Eigen::Index i) const override {
    if (i < x_.size()) return "input " + place(i, x_);
    if ((i -= x_.size()) < u_.size()) return "inducing point " + place(i, u_);
    if ((i -= u_.size()) < y_.size()) return "output " + place(i, y_);
    return "log " + parameter_names(kernel_)[static_cast<std::size_t>(i - y_.size())];
  }

 private:
  static std::string place(Eigen::Index i, const Eigen::MatrixXd& m) {
    return std::to_string(i % m.rows()) + ", dimension " + std::to_string(i / m.rows());
  }
  GpLikelihood& likelihood_;
  Kernel kernel_;
  Eigen::MatrixXd x_, u_, y_;
  GpGradient g_;
};

}  // namespace talkgraph::testing
