#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace talkgraph {

/// A cost to be minimised, such as a negative log-likelihood.
class Objective {
 public:
  virtual ~Objective() = default;
  /// Number of parameters.
  virtual Eigen::Index size() const = 0;
  /// Computes the cost and, where `gradient` is not null, its derivatives; the
  /// cost is the same bits either way. Returns false where the cost cannot be
  /// evaluated (a matrix that cannot be factorised); optimisers step back.
  virtual bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) = 0;
  /// What a reader calls the parameter.
  virtual std::string name(Eigen::Index parameter) const { return "parameter " + std::to_string(parameter); }
};

/// What comparing an objective's gradient with central differences gave.
struct GradientCheck {
  bool evaluated = false;        ///< every evaluation succeeded
  bool cost_consistent = false;  ///< the cost does not depend on whether the gradient was asked for
  double worst = 0;              ///< largest error
  Eigen::Index where = -1;       ///< its parameter
  Eigen::VectorXd analytic, numeric;
  /// |analytic − numeric| over |numeric|, which is taken as a hundredth of max(1, largest |numeric|) where it is less:
  /// of smaller derivatives, rounding and the steps leave too few digits.
  Eigen::VectorXd error;
  std::vector<std::string> names;

  /// One line that says how the check went and, where derivatives differ, a table of the `rows` largest errors.
  std::string report(std::size_t rows = 10) const;
};

/// Central differences of fourth order with steps of `step` · max(1, |parameter|).
GradientCheck check_gradient(Objective& objective, const Eigen::VectorXd& parameters, double step = 5e-4);

}  // namespace talkgraph
