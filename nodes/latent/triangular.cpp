#include "nodes/latent/triangular.h"

#include <Eigen/Dense>

namespace talkgraph {

namespace {

void multiply(const char* transposed, const Eigen::MatrixXd& l, MatrixBlock b) {
  const int rows = static_cast<int>(b.rows()), cols = static_cast<int>(b.cols());
  const int l_stride = static_cast<int>(l.outerStride()), b_stride = static_cast<int>(b.outerStride());
  const double one = 1;
  if (b.size() > 0) dtrmm_("R", "L", transposed, "N", &rows, &cols, &one, l.data(), &l_stride, b.data(), &b_stride);
}

}  // namespace

void solve_transposed_right(const Eigen::MatrixXd& l, MatrixBlock b) {
  l.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(b);
}

void multiply_right(const Eigen::MatrixXd& l, MatrixBlock b) { multiply("N", l, b); }

void multiply_transposed_right(const Eigen::MatrixXd& l, MatrixBlock b) { multiply("T", l, b); }

void invert_lower(const Eigen::MatrixXd& l, Eigen::MatrixXd& inverse) {
  inverse.setIdentity(l.rows(), l.cols());
  l.triangularView<Eigen::Lower>().solveInPlace(inverse);
}

}  // namespace talkgraph
