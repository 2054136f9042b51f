#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "graph/description.h"

namespace talkgraph {

enum class CovarianceKind { full, diagonal };
template <>
inline constexpr EnumNames<CovarianceKind, 2> enum_names<CovarianceKind>{
    {{CovarianceKind::full, "full"}, {CovarianceKind::diagonal, "diagonal"}}};

/// ln N(x | 0, Σ) of every column of D × N.
Eigen::VectorXd log_normal(const Eigen::LLT<Eigen::MatrixXd>& covariance, const Eigen::MatrixXd& columns);
/// The same of a covariance D × D, or D × 1 if it is diagonal. Throws std::runtime_error if it is not positive
/// definite.
Eigen::VectorXd log_normal(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& columns);

/// The inverse, D × D, of a covariance D × D, or D × 1 if it is diagonal. Throws std::runtime_error if it is not
/// positive definite.
Eigen::MatrixXd precision(const Eigen::MatrixXd& covariance);

/// The least variance that models of these frames may have, a dimension each: `share` of its variance. A dimension that
/// does not vary has the mean variance of all in place of its own; if none varies, 1.
Eigen::VectorXd variance_floors(const Eigen::MatrixXd& frames, double share);

/// The likeliest covariance given a sample's (D × D, or D × 1 if it is diagonal) of all that exceed diag(floors), Σ −
/// diag(floors) being positive semidefinite: eigenvalues in units of the floors are raised to 1.
Eigen::MatrixXd floored(const Eigen::MatrixXd& sample, const Eigen::VectorXd& floors);

/// Mean outer product of rows by their weights, D × D, or D × 1 its diagonal.
Eigen::MatrixXd scatter(const Eigen::MatrixXd& rows, const Eigen::VectorXd& weights, CovarianceKind kind);

/// ln Σ exp of each row; −∞ where all are.
Eigen::VectorXd log_sum_rows(const Eigen::MatrixXd& logs);

}  // namespace talkgraph
