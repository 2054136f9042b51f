#pragma once

#include <Eigen/Core>

// Solutions with lower triangular matrices L, inverses, and products that leave out what is nought or not wanted.
namespace talkgraph {

using MatrixBlock = Eigen::Ref<Eigen::MatrixXd>;
using ConstMatrixBlock = Eigen::Ref<const Eigen::MatrixXd>;

/// X = L⁻¹ B, using B up. Of the inverse only blocks beside the diagonal are used, so that X is as good as by
/// substitution.
void solve_left(const Eigen::MatrixXd& l, const Eigen::MatrixXd& inverse, MatrixBlock b, MatrixBlock x);
/// B ← B L⁻¹.
void solve_right(const ConstMatrixBlock& l, MatrixBlock b);
/// B ← B L⁻ᵀ.
void solve_transposed_right(const ConstMatrixBlock& l, MatrixBlock b);
/// L⁻¹; above the diagonal it is zero.
void invert_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd& inverse);
/// A B.
void multiply(const ConstMatrixBlock& a, const ConstMatrixBlock& b, MatrixBlock product);
/// U B, U upper triangular.
void multiply_upper(const Eigen::MatrixXd& u, const ConstMatrixBlock& b, MatrixBlock product);
/// Adds the lower triangle of A Bᵀ to that of `sum`, of whose upper triangle nothing is kept.
void add_lower(const ConstMatrixBlock& a, const ConstMatrixBlock& b, Eigen::MatrixXd& sum);
/// The same of factor · Aᵀ B.
void add_lower(double factor, const ConstMatrixBlock& a, const ConstMatrixBlock& b, Eigen::MatrixXd& sum);

}  // namespace talkgraph
