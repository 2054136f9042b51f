#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "nodes/types/sgpdm.h"

namespace talkgraph {

using ConstMatrix = Eigen::Ref<const Eigen::MatrixXd>;
using MatrixView = Eigen::Ref<Eigen::MatrixXd>;
using VectorView = Eigen::Ref<Eigen::VectorXd>;

/// Number of log parameters: an RBF term has two (variance, inverse width), one with ARD 1 + d, the others one
/// (variance).
Eigen::Index parameter_count(const Kernel& kernel);
/// Their names, in order: "rbf_variance", "inverse_width", or "ard_variance", "inverse_width_1", ..., or "linear",
/// "bias", "white".
std::vector<std::string> parameter_names(const Kernel& kernel);
/// 0 where a parameter is white noise, 1 elsewhere.
Eigen::VectorXd without_noise(const Kernel& kernel);
/// Natural logarithms of the parameters, of white noise without its floor.
Eigen::VectorXd log_parameters(const Kernel& kernel);
void set_log_parameters(Kernel& kernel, const Eigen::Ref<const Eigen::VectorXd>& logs);

/// Variance of the white terms.
double white_variance(const Kernel& kernel);
/// Adds the derivative with respect to the log parameters, given that with respect to the white variance.
void white_gradient(const Kernel& kernel, double derivative, VectorView logs);

/// k(x, x) of every row, without white noise.
void diagonal(const Kernel& kernel, const ConstMatrix& x, VectorView values);
/// Adds derivatives given those with respect to diagonal(), `g`.
void diagonal_gradient(const Kernel& kernel, const ConstMatrix& x, const Eigen::Ref<const Eigen::VectorXd>& g,
                       MatrixView x_gradient, VectorView logs);

/// Throws std::invalid_argument if an ARD term has not as many inverse widths as there are dimensions.
void require_dimension(const Kernel& kernel, Eigen::Index dimension);

/// The matrix k(A, B) without white noise, with what its gradient needs; its
/// memory is used again by the next computation of the same size.
class KernelMatrix {
 public:
  /// A is n × d, B is m × d; the result n × m.
  const Eigen::MatrixXd& compute(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b);
  const Eigen::MatrixXd& value() const { return value_; }
  /// The same into a matrix of the caller's, n × m already; value() is then left as it was.
  void compute(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b, MatrixView value);

  /// Adds to the gradients with respect to A, B and the log parameters, given
  /// the derivative `g` with respect to the matrix. Takes the arguments of the
  /// last computation; A and B, and their gradients, may be the same.
  void gradient(const Kernel& kernel, const ConstMatrix& a, const ConstMatrix& b, const ConstMatrix& g,
                MatrixView a_gradient, MatrixView b_gradient, VectorView logs);

 private:
  void add_rbf(double variance, const ConstMatrix& a, const ConstMatrix& b, Eigen::MatrixXd& values, MatrixView sum);
  double rbf_gradient(const Eigen::MatrixXd& values, const ConstMatrix& a, const ConstMatrix& b, const ConstMatrix& g,
                      MatrixView a_gradient, MatrixView b_gradient);

  Eigen::MatrixXd value_, a_sum_, b_sum_;
  std::vector<Eigen::MatrixXd> rbf_;            // of each RBF term
  Eigen::VectorXd widths_, squares_, weights_;  // inverse widths of the term at hand; Σ w δ² of every dimension
  Eigen::RowVectorXd point_, total_;
};

}  // namespace talkgraph
