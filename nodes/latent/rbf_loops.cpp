#include "nodes/latent/rbf_loops.h"

#include <bit>
#include <cstdint>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TALKGRAPH_VECTORISED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define TALKGRAPH_VECTORISED
#endif

namespace talkgraph::rbf {

TALKGRAPH_VECTORISED
void values(double variance, const double* inverse_widths, Eigen::Index dimension, const double* a, Eigen::Index stride,
            Eigen::Index n, const double* b, double* values, double* sums) {
  for (Eigen::Index i = 0; i < n; ++i) values[i] = 0;
  for (Eigen::Index c = 0; c < dimension; ++c) {
    const double* column = a + c * stride;
    const double centre = b[c], factor = -0.5 * inverse_widths[c];
    for (Eigen::Index i = 0; i < n; ++i) {
      const double difference = column[i] - centre;
      values[i] += factor * difference * difference;
    }
  }
  // exp(x) = 2^m · exp(r), m the nearest integer to x / ln 2 and |r| ≤ ln 2 / 2, where the series of exp to r^13 is
  // exact to rounding. Adding 1.5 · 2^52 leaves m in the low bits of a double, its exponent field a shift away.
  constexpr double shift = 0x1.8p52, log2e = 1.4426950408889634, ln2_high = 0x1.62e42fefap-1,
                   ln2_low = 0x1.cf79abc9e3b3ap-40;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = values[i];
    const double shifted = x * log2e + shift, m = shifted - shift;
    const double r = (x - m * ln2_high) - m * ln2_low;
    double series = 1.0 / 6227020800;
    series = series * r + 1.0 / 479001600;
    series = series * r + 1.0 / 39916800;
    series = series * r + 1.0 / 3628800;
    series = series * r + 1.0 / 362880;
    series = series * r + 1.0 / 40320;
    series = series * r + 1.0 / 5040;
    series = series * r + 1.0 / 720;
    series = series * r + 1.0 / 120;
    series = series * r + 1.0 / 24;
    series = series * r + 1.0 / 6;
    series = series * r + 0.5;
    series = (series * r + 1) * r + 1;
    const double power = std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023) << 52);
    values[i] = x < -708 ? 0 : variance * (power * series);
    sums[i] += values[i];
  }
}

TALKGRAPH_VECTORISED
double pulls(const double* derivatives, const double* values, Eigen::Index dimension, const double* a,
             Eigen::Index stride, Eigen::Index n, const double* b, double* weights, double* pulls,
             Eigen::Index pull_stride, double* totals, double* squares) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (Eigen::Index i = 0; i < n; ++i) {
    weights[i] = derivatives[i] * values[i];
    sum += weights[i];
  }
  for (Eigen::Index c = 0; c < dimension; ++c) {
    const double* column = a + c * stride;
    double* pull = pulls + c * pull_stride;
    const double centre = b[c];
    double total = 0, square = 0;
#pragma omp simd reduction(+ : total, square)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double difference = column[i] - centre, weighted = weights[i] * difference;
      pull[i] += weighted;
      total += weighted;
      square += weighted * difference;
    }
    totals[c] += total;
    squares[c] += square;
  }
  return sum;
}

}  // namespace talkgraph::rbf
