#include "nodes/speech/line_spectrum.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

// LAPACK: eigenvalues of a symmetric tridiagonal matrix, ascending in place of its diagonal.
extern "C" void dsterf_(const int* n, double* diagonal, double* beside, int* info);

namespace talkgraph {
namespace {

using Eigen::Index;
using std::numbers::pi;

/// A Newton step towards a root of Σ w_j cos((first + j) ω - phase).
double newton(const Eigen::VectorXd& weights, double first, double phase, double omega) {
  const double cosine = std::cos(omega), sine = std::sin(omega);
  double re = std::cos(first * omega - phase), im = std::sin(first * omega - phase), value = 0, slope = 0;
  for (Index j = 0; j < weights.size(); ++j) {
    value += weights[j] * re;
    slope -= weights[j] * (first + static_cast<double>(j)) * im;
    const double turned = re * cosine - im * sine;
    im = re * sine + im * cosine;
    re = turned;
  }
  return omega - value / slope;
}

}  // namespace

bool step_down(const Eigen::Ref<const Eigen::VectorXd>& a, Eigen::Ref<Eigen::VectorXd> k) {
  k = a;
  for (Index m = k.size() - 1; m >= 0; --m) {
    if (!(std::abs(k[m]) < 1)) return false;
    for (Index i = 0, j = m - 1; i <= j; ++i, --j) {  // in halves, as what is left of 1 - k² may be little
      const double even = (k[i] + k[j]) / (1 - k[m]) / 2, odd = (k[i] - k[j]) / (1 + k[m]) / 2;
      k[i] = even + odd;
      k[j] = even - odd;
    }
  }
  return true;
}

Eigen::VectorXd minimum_phase(const Eigen::Ref<const Eigen::VectorXd>& a) {
  const auto p = a.size();
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(p, p);
  companion.row(0) = a.transpose();
  companion.diagonal(-1).setOnes();
  Eigen::VectorXcd roots = companion.eigenvalues(), product(p + 1);
  Eigen::VectorXd k(p);
  for (auto& z : roots)
    if (std::abs(z) > 1) z /= std::norm(z);
  for (double margin = 1e-10; margin < 1; margin *= 10) {
    product.setZero();
    product[0] = 1;
    for (Index i = 0; i < p; ++i) {
      const auto z = roots[i] * std::min(1.0, (1 - margin) / std::abs(roots[i]));
      for (Index j = i + 1; j > 0; --j) product[j] -= z * product[j - 1];
    }
    const Eigen::VectorXd inside = -product.tail(p).real();
    if (step_down(inside, k)) return inside;
  }
  return Eigen::VectorXd::Zero(p);
}

bool LineSpectrum::operator()(const Eigen::Ref<const Eigen::VectorXd>& a, Eigen::Ref<Eigen::VectorXd> lsf) {
  a_ = a;
  k_.resize(a.size());
  const bool stable = step_down(a_, k_);
  if (!stable) {
    a_ = minimum_phase(a);
    step_down(a_, k_);
  }
  start(1, lsf);
  start(-1, lsf);
  for (Index i = 1; i < lsf.size(); ++i) lsf[i] = std::max(lsf[i], lsf[i - 1]);
  refine(lsf);
  return stable;
}

// P_{m+1} = (1 + z^-1) P_m - s_m z^-1 P_{m-1}: the s_m are the squares beside the zero diagonal of a symmetric matrix
// whose eigenvalues are 2 cos(ω/2), in pairs ±. Its square falls apart into two of half the size; the even one has each
// pair once and no 0. Q / (1 - z^-1) likewise, with the other sign of k.
void LineSpectrum::start(double sign, Eigen::Ref<Eigen::VectorXd> lsf) {
  const auto p = lsf.size();
  squares_.setZero(p + 1);
  Index count = 0;
  for (Index m = sign > 0 ? 0 : 1; m < p; ++m)
    squares_[count++] = (1 + sign * k_[m]) * (m > 0 ? 1 - sign * k_[m - 1] : 2);
  const auto n = (count + 1) / 2;
  if (n == 0) return;
  diagonal_.resize(n);
  beside_.resize(n - 1);
  for (Index i = 0; i < n; ++i) diagonal_[i] = squares_[2 * i] + squares_[2 * i + 1];
  for (Index i = 0; i + 1 < n; ++i) beside_[i] = std::sqrt(squares_[2 * i + 1] * squares_[2 * i + 2]);
  const int size = static_cast<int>(n);
  int info = 0;
  dsterf_(&size, diagonal_.data(), beside_.data(), &info);
  if (info != 0) throw std::runtime_error("line spectral frequencies were not found: the predictor is no finite one");
  constexpr double one = 1 - std::numeric_limits<double>::epsilon();
  for (Index i = 0; i < n; ++i)
    lsf[2 * (n - 1 - i) + (sign > 0 ? 0 : 1)] = std::acos(std::clamp(diagonal_[i] / 2 - 1, -one, one));
}

// On the unit circle P is Σ w_j cos(f_j ω) and Q is Σ w_j sin(f_j ω), but for a factor that is nowhere 0,
// f_j = j + ½ for even orders and j for odd ones.
void LineSpectrum::refine(Eigen::Ref<Eigen::VectorXd> lsf) {
  const auto p = lsf.size(), terms = (p + 1) / 2 + 1;
  const double first = p % 2 == 0 ? 0.5 : 0;
  const auto coefficient = [&](Index i) { return i == 0 ? 1.0 : i <= p ? -a_[i - 1] : 0.0; };
  cosines_.resize(terms);
  sines_.resize(terms);
  for (Index j = 0; j < terms; ++j) {
    const double front = coefficient(terms - 1 - j), back = coefficient(p + 2 - terms + j);
    cosines_[j] = front + back;
    sines_[j] = front - back;
  }
  if (first == 0) cosines_[0] /= 2;
  for (Index i = 0; i < p; ++i) {
    const bool of_p = i % 2 == 0;
    const double low = i > 0 ? lsf[i - 1] : 0, high = i + 1 < p ? lsf[i + 1] : pi;
    double moved = 1;
    for (int n = 0; n < 8 && moved > 1e-8; ++n) {
      const double next = newton(of_p ? cosines_ : sines_, first, of_p ? 0 : pi / 2, lsf[i]);
      if (!(next > low && next < high)) break;
      moved = std::abs(next - lsf[i]);
      lsf[i] = next;
    }
  }
}

void predictor_of(const Eigen::Ref<const Eigen::VectorXd>& lsf, Eigen::Ref<Eigen::VectorXd> a) {
  const auto p = lsf.size();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(p + 2), difference = sum;  // P and Q
  sum[0] = difference[0] = 1;
  const auto times = [p](Eigen::VectorXd& product, double first, double second) {  // 1 + first z^-1 + second z^-2
    for (Index j = p + 1; j > 1; --j) product[j] += first * product[j - 1] + second * product[j - 2];
    product[1] += first * product[0];
  };
  const auto add = [&](Index k) { times(k % 2 == 0 ? sum : difference, -2 * std::cos(lsf[k]), 1); };
  for (Index low = 0, high = p - 1; low <= high; ++low, --high) {  // in turn, which keeps the products small
    add(low);
    if (low < high) add(high);
  }
  if (p % 2 == 0) {
    times(sum, 1, 0);
    times(difference, -1, 0);
  } else {
    times(difference, 0, -1);
  }
  a = -(sum + difference).segment(1, p) / 2;
}

void check_spacing(double spacing, Index count) {
  if (spacing * static_cast<double>(count + 1) >= pi)
    throw std::invalid_argument(
        fmt::format("{} line spectral frequencies do not fit {} rad apart below π", count, spacing));
}

void keep_apart(double spacing, Eigen::Ref<Eigen::VectorXd> lsf) {
  std::sort(lsf.begin(), lsf.end());
  double low = 0;
  for (auto& omega : lsf) low = omega = std::max(omega, low + spacing);
  double high = pi;
  for (auto omega = lsf.end(); omega != lsf.begin();) {
    --omega;
    high = *omega = std::min(*omega, high - spacing);
  }
}

}  // namespace talkgraph
