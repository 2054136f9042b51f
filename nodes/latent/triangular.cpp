#include "nodes/latent/triangular.h"

#include <Eigen/Dense>
#include <algorithm>

namespace talkgraph {

namespace {

constexpr Eigen::Index small = 24;  // rows that a product of OpenBLAS takes at a time

/// B ← factor · B L with side "R", factor · L B with "L".
void multiply_triangular(const char* side, double factor, const ConstMatrixBlock& l, MatrixBlock b) {
  const int rows = static_cast<int>(b.rows()), cols = static_cast<int>(b.cols());
  const int l_stride = static_cast<int>(l.outerStride()), b_stride = static_cast<int>(b.outerStride());
  if (b.size() > 0) dtrmm_(side, "L", "N", "N", &rows, &cols, &factor, l.data(), &l_stride, b.data(), &b_stride);
}

/// C ← factor · A B + kept · C, A transposed with "T". Eigen would write zeros first, and copy what is small.
void product(const char* transposed, double factor, const ConstMatrixBlock& a, const ConstMatrixBlock& b, double kept,
             MatrixBlock c) {
  const int rows = static_cast<int>(c.rows()), cols = static_cast<int>(c.cols()), inner = static_cast<int>(b.rows());
  const int a_stride = static_cast<int>(a.outerStride()), b_stride = static_cast<int>(b.outerStride()),
            c_stride = static_cast<int>(c.outerStride());
  if (inner > 0)
    dgemm_(transposed, "N", &rows, &cols, &inner, &factor, a.data(), &a_stride, b.data(), &b_stride, &kept, c.data(),
           &c_stride);
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
  multiply_triangular("R", -1, l.topLeftCorner(half, half), l.bottomLeftCorner(rest, half));
  multiply_triangular("L", 1, l.bottomRightCorner(rest, rest), l.bottomLeftCorner(rest, half));
}

}  // namespace

// OpenBLAS solves at half the speed of its products or less, which halving the matrix again and again turns most of it
// into.
void solve_right(const ConstMatrixBlock& l, MatrixBlock b) {
  if (l.rows() <= small) {
    l.triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(b);
    return;
  }
  const Eigen::Index half = l.rows() / 2, rest = l.rows() - half;
  solve_right(l.bottomRightCorner(rest, rest), b.rightCols(rest));
  b.leftCols(half).noalias() -= b.rightCols(rest) * l.bottomLeftCorner(rest, half);
  solve_right(l.topLeftCorner(half, half), b.leftCols(half));
}

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

// A few rows at a time: their products leave out most of what is nought or not wanted.
void solve_left(const Eigen::MatrixXd& l, const Eigen::MatrixXd& inverse, MatrixBlock b, MatrixBlock x) {
  for (Eigen::Index i = 0; i < l.rows(); i += small) {
    const Eigen::Index rows = std::min(small, l.rows() - i);
    if (i > 0) b.middleRows(i, rows).noalias() -= l.block(i, 0, rows, i) * x.topRows(i);
    multiply(inverse.block(i, i, rows, rows), b.middleRows(i, rows), x.middleRows(i, rows));
  }
}

void multiply(const ConstMatrixBlock& a, const ConstMatrixBlock& b, MatrixBlock c) { product("N", 1, a, b, 0, c); }

void multiply_upper(const Eigen::MatrixXd& u, const ConstMatrixBlock& b, MatrixBlock product) {
  for (Eigen::Index i = 0; i < u.rows(); i += small) {
    const Eigen::Index rest = u.rows() - i, rows = std::min(small, rest);
    multiply(u.block(i, i, rows, rest), b.bottomRows(rest), product.middleRows(i, rows));
  }
}

void add_lower(const ConstMatrixBlock& a, const ConstMatrixBlock& b, Eigen::MatrixXd& sum) {
  for (Eigen::Index i = 0; i < sum.rows(); i += small) {
    const Eigen::Index rows = std::min(small, sum.rows() - i), cols = i + rows;
    sum.block(i, 0, rows, cols).noalias() += a.middleRows(i, rows) * b.topRows(cols).transpose();
  }
}

void add_lower(double factor, const ConstMatrixBlock& a, const ConstMatrixBlock& b, Eigen::MatrixXd& sum) {
  for (Eigen::Index i = 0; i < sum.rows(); i += small) {
    const Eigen::Index rows = std::min(small, sum.rows() - i), cols = i + rows;
    product("T", factor, a.middleCols(i, rows), b.leftCols(cols), 1, sum.block(i, 0, rows, cols));
  }
}

void invert_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd& inverse) {
  double memory[small * small];
  inverse = l;
  invert_in_place(inverse, memory);
}

}  // namespace talkgraph
