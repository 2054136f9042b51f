#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "nodes/latent/observed_outputs.h"
#include "nodes/latent/psi_statistics.h"
#include "nodes/latent/variational_bound.h"

namespace talkgraph {

/// Means and variances of q(X), or derivatives by them, N × d each.
struct GaussianRows {
  Eigen::MatrixXd mean, variance;

  void set_zero(Eigen::Index rows, Eigen::Index d) {
    mean.setZero(rows, d);
    variance.setZero(rows, d);
  }
};

/// Parameters of the process that maps latent points to one stream.
struct VariationalProcess {
  ArdKernel kernel;
  double noise = 0.1;
  double minimum_noise = 0;
  Eigen::MatrixXd inducing;  ///< M × d

  /// Inducing points column by column, then logarithms of variance, bias, noise above its minimum, inverse widths.
  Eigen::Index size() const { return inducing.size() + 3 + inducing.cols(); }
  Eigen::VectorXd parameters() const;
  void set(const Eigen::Ref<const Eigen::VectorXd>& parameters);
};

/// Bounds of the likelihood of one stream as functions of q(X) and the process, with memory for a part of the rows
/// and of the pairs of inducing points, whatever their number.
class VariationalStream {
 public:
  VariationalStream(std::string name, ObservedOutputs outputs, VariationalProcess process);

  const std::string& name() const { return name_; }
  const ObservedOutputs& outputs() const { return outputs_; }
  const VariationalProcess& process() const { return process_; }
  Eigen::Index size() const { return process_.size(); }
  /// Where the noise stands among the parameters.
  Eigen::Index noise_place() const { return process_.inducing.size() + 2; }

  /// Classes of some of the rows, which are in rising order.
  std::vector<ObservedOutputs::Class> classes_of(const std::vector<Eigen::Index>& rows) const;

  /// Takes new parameters; comes before each evaluation. Throws FactorisationError.
  void begin(const Eigen::Ref<const Eigen::VectorXd>& parameters);
  /// Bound of all rows with the best inducing variables; derivatives are added to `rows` and assigned to `parameters`.
  double collapsed(const GaussianRows& q, GaussianRows* rows, VectorView parameters);
  /// Moves the inducing variables by `step` towards what some rows, taken for all, want, then bounds those rows
  /// times `scale`; derivatives as in collapsed().
  double stochastic(const std::vector<ObservedOutputs::Class>& classes, double scale, double step,
                    const GaussianRows& q, GaussianRows& rows, VectorView parameters);
  /// Basis, weights and reduction of the process given all rows.
  GaussianProcess posterior(const GaussianRows& q);
  double jitter() const { return jitter_; }
  /// What stochastic() has moved so far.
  StochasticBound& inducing_posterior() { return stochastic_; }

 private:
  using Classes = std::vector<ObservedOutputs::Class>;
  template <class F>
  void each_part(const Classes& classes, const GaussianRows& q, F f);
  void gather(const Classes& classes, const GaussianRows& q);
  void chain(const Classes& classes, const GaussianRows& q, GaussianRows& rows, VectorView parameters);

  std::string name_;
  ObservedOutputs outputs_;
  std::vector<std::size_t> class_of_;  // of each row; number of classes where it has none
  VariationalProcess process_;
  PsiStatistics psi_;
  InducingVariables inducing_;
  CollapsedBound collapsed_;
  StochasticBound stochastic_;
  RowStatistics statistics_;
  BoundGradient by_;
  GaussianRows part_, part_gradient_;
  Eigen::MatrixXd y_, psi2_, by_psi1_;
  bool one_part_ = false;
  double jitter_ = 0;
};

}  // namespace talkgraph
