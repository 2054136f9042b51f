#pragma once

#include <Eigen/Core>

namespace talkgraph {

/// Reflection coefficients k_1 ... k_p of the predictor a_1 ... a_p by the backward Levinson recursion. Returns whether
/// A(z) = 1 - Σ a_k z^-k is of minimum phase, all |k| < 1; if not, what is in `k` means nothing.
bool step_down(const Eigen::Ref<const Eigen::VectorXd>& a, Eigen::Ref<Eigen::VectorXd> k);

/// The predictor whose |A| has the same shape and whose roots are all inside the unit circle: those outside are
/// mirrored at it, those on it drawn in by a little.
Eigen::VectorXd minimum_phase(const Eigen::Ref<const Eigen::VectorXd>& a);

/// Line spectral frequencies of predictors, frame by frame; keeps its memory.
///
/// They are the angles, ascending in (0, π), of the roots of P(z) = A(z) + z^-(p+1) A(1/z) and Q(z) = A(z) - z^-(p+1)
/// A(1/z), of both in turn. The singular predictors P_m follow from the reflection coefficients by a recursion of three
/// terms (Delsarte & Genin, 1986), so the squares of their 2 cos(ω/2) are the eigenvalues of symmetric tridiagonal
/// matrices: none is missed, however near to each other. Newton steps on P and Q refine them to machine precision.
class LineSpectrum {
 public:
  /// `a` must be finite. Returns whether A was of minimum phase; if not, the frequencies are those of minimum_phase(a).
  bool operator()(const Eigen::Ref<const Eigen::VectorXd>& a, Eigen::Ref<Eigen::VectorXd> lsf);

 private:
  void start(double sign, Eigen::Ref<Eigen::VectorXd> lsf);
  void refine(Eigen::Ref<Eigen::VectorXd> lsf);

  Eigen::VectorXd a_, k_, squares_, diagonal_, beside_, cosines_, sines_;
};

/// The predictor of line spectral frequencies: A = (P + Q) / 2. `a` is as long as `lsf`.
void predictor_of(const Eigen::Ref<const Eigen::VectorXd>& lsf, Eigen::Ref<Eigen::VectorXd> a);

/// Throws std::invalid_argument if `count` frequencies do not fit into (0, π) with that spacing.
void check_spacing(double spacing, Eigen::Index count);

/// Sorts frequencies and moves them, where they are nearer, `spacing` rad apart and away from 0 and π. With a spacing
/// above 0 the predictor is of minimum phase, but for rounding errors where many are that near.
void keep_apart(double spacing, Eigen::Ref<Eigen::VectorXd> lsf);

}  // namespace talkgraph
