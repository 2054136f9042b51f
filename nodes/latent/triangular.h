#pragma once

#include <Eigen/Core>

// Products and solutions with lower triangular matrices from the right, in place, rows of B being frames.
namespace talkgraph {

using MatrixBlock = Eigen::Ref<Eigen::MatrixXd>;
using ConstMatrixBlock = Eigen::Ref<const Eigen::MatrixXd>;

/// B ← B L⁻ᵀ.
void solve_transposed_right(const ConstMatrixBlock& l, MatrixBlock b);
/// B ← B L, which BLAS does in place (Eigen's product of a triangular matrix makes copies).
void multiply_right(const Eigen::MatrixXd& l, MatrixBlock b);
/// L⁻¹ of a lower triangular L; above the diagonal it is zero.
void invert_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd& inverse);

}  // namespace talkgraph
