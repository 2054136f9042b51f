#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// The RBF kernel's loops over pairs of points, written for the compiler to
/// vectorise and compiled for several processors, of which the one at hand is
/// chosen at run time. Differences of coordinates are taken before they are
/// squared: far from the origin a kernel is as accurate as at it.
namespace rbf {

/// values_i = variance · exp(−½ Σ_c inverse_widths_c (a_ic − b_c)²) for the n points a_i, whose coordinate c begins at
/// a + c · stride; added to sums_i as well. Within 2 ulp of the exact function of the sum; 0 where that is below
/// e^−708.
void values(double variance, const double* inverse_widths, Eigen::Index dimension, const double* a, Eigen::Index stride,
            Eigen::Index n, const double* b, double* values, double* sums);

/// With w_i = derivatives_i · values_i, written to `weights`: per coordinate c adds w_i (a_ic − b_c) to pulls_ic, laid
/// out as the points are, Σ_i w_i (a_ic − b_c) to totals_c and Σ_i w_i (a_ic − b_c)² to squares_c. Returns Σ_i w_i.
double pulls(const double* derivatives, const double* values, Eigen::Index dimension, const double* a,
             Eigen::Index stride, Eigen::Index n, const double* b, double* weights, double* pulls,
             Eigen::Index pull_stride, double* totals, double* squares);

}  // namespace rbf
}  // namespace talkgraph
