#include "nodes/latent/triangular.h"

#include <Eigen/Dense>

namespace talkgraph {

namespace {

constexpr Eigen::Index small = 32;

/// B ← factor · B L with side "R", factor · L B with "L".
void multiply(const char* side, double factor, const ConstMatrixBlock& l, MatrixBlock b) {
  const int rows = static_cast<int>(b.rows()), cols = static_cast<int>(b.cols());
  const int l_stride = static_cast<int>(l.outerStride()), b_stride = static_cast<int>(b.outerStride());
  if (b.size() > 0) dtrmm_(side, "L", "N", "N", &rows, &cols, &factor, l.data(), &l_stride, b.data(), &b_stride);
}

/// Of the lower triangle of `l`, which holds a factor.
void invert_in_place(MatrixBlock l, double* memory) {
  const Eigen::Index n = l.rows(), half = n / 2, rest = n - half;
  if (n <= small) {
    Eigen::Map<Eigen::MatrixXd> inverse(memory, n, n);
    inverse.setIdentity();
    l.triangularView<Eigen::Lower>().solveInPlace(inverse);
    l = inverse;
    return;
  }
  invert_in_place(l.topLeftCorner(half, half), memory);
  invert_in_place(l.bottomRightCorner(rest, rest), memory);
  multiply("R", -1, l.topLeftCorner(half, half), l.bottomLeftCorner(rest, half));
  multiply("L", 1, l.bottomRightCorner(rest, rest), l.bottomLeftCorner(rest, half));
}

}  // namespace

// OpenBLAS solves at half the speed of its products, which halving the matrix again and again turns most of it into.
void solve_transposed_right(const ConstMatrixBlock& l, MatrixBlock b) {
  if (l.rows() <= small) {
    l.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(b);
    return;
  }
  const Eigen::Index half = l.rows() / 2, rest = l.rows() - half;
  solve_transposed_right(l.topLeftCorner(half, half), b.leftCols(half));
  b.rightCols(rest).noalias() -= b.leftCols(half) * l.bottomLeftCorner(rest, half).transpose();
  solve_transposed_right(l.bottomRightCorner(rest, rest), b.rightCols(rest));
}

void multiply_right(const Eigen::MatrixXd& l, MatrixBlock b) { multiply("R", 1, l, b); }

void invert_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd& inverse) {
  double memory[small * small];
  inverse = l;
  invert_in_place(inverse, memory);
}

}  // namespace talkgraph
