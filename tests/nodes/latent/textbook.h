#pragma once

#include <Eigen/Core>
#include <vector>

#include "nodes/types/sgpdm.h"
#include "tests/nodes/latent/gaussian.h"

// Kernels and densities as textbooks write them, for comparison.
namespace talkgraph::testing {

/// k(a, b) of the sum, term by term, without white noise.
double textbook_kernel(const Kernel& kernel, const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b);
Eigen::MatrixXd textbook_matrix(const Kernel& kernel, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
double textbook_white(const Kernel& kernel);

/// Σ_d ln N(y_d; 0, covariance).
double textbook_density(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& y);

Eigen::MatrixXd textbook_full(const Kernel& kernel, const Eigen::MatrixXd& x);
/// K_fu K_uu⁻¹ K_uf.
Eigen::MatrixXd textbook_q(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u);
Eigen::MatrixXd textbook_dtc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u);
Eigen::MatrixXd textbook_fitc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u);
Eigen::MatrixXd textbook_pitc(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u,
                              const std::vector<Eigen::Index>& blocks);
/// Titsias' bound: the density of DTC less the trace term.
double textbook_bound(const Kernel& kernel, const Eigen::MatrixXd& x, const Eigen::MatrixXd& u,
                      const Eigen::MatrixXd& y);
Eigen::MatrixXd textbook_inverse(const Eigen::MatrixXd& a);

}  // namespace talkgraph::testing
