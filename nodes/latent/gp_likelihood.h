#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nodes/latent/cholesky.h"
#include "nodes/latent/kernel.h"

namespace talkgraph {

/// Derivatives of a log-likelihood; `inputs`, `inducing` and `kernel` are added to.
struct GpGradient {
  Eigen::MatrixXd inputs;    ///< N × d
  Eigen::MatrixXd inducing;  ///< k × d
  Eigen::VectorXd kernel;    ///< log parameters
  Eigen::MatrixXd outputs;   ///< N × D, assigned

  void set_zero(Eigen::Index n, Eigen::Index k, Eigen::Index d, Eigen::Index parameters);
};

/// ln p(Y | X) of D independent Gaussian processes with one covariance, a true
/// density: Σ_d ln N(y_d; 0, K). One type derives from it for each
/// approximation of K; evaluating uses its memory again, so that evaluations of
/// one size allocate nothing but the first. No jitter is part of a model: it is
/// added where a matrix cannot be factorised without, and derivatives are those
/// of the value with it.
class GpLikelihood {
 public:
  virtual ~GpLikelihood() = default;
  /// Whether inducing points are used; where not, `u` is ignored and may be empty.
  virtual bool has_inducing() const = 0;
  /// X is N × d, U k × d, Y N × D. Throws FactorisationError where the value or a
  /// derivative cannot be computed or is not finite, std::invalid_argument where sizes do not fit.
  virtual double evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                          GpGradient* gradient) = 0;
  /// Basis, weights and root of the process given the data (scale and mean stay empty).
  virtual GaussianProcess posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                    const ConstMatrix& y) = 0;
  /// Largest jitter share used since the start.
  double jitter() const { return jitter_; }

 protected:
  void note(const Cholesky& c) { jitter_ = std::max(jitter_, c.jitter()); }
  static void check(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& y);
  static void check_finite(double value, const GpGradient* gradient, const ConstMatrix& x, const ConstMatrix& u,
                           const ConstMatrix& y);

 private:
  double jitter_ = 0;
};

/// K = k(X, X) + white·I, exactly. O(N³).
class FullLikelihood : public GpLikelihood {
 public:
  bool has_inducing() const override { return false; }
  double evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                  GpGradient* gradient) override;
  GaussianProcess posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                            const ConstMatrix& y) override;

 private:
  void factorise(const Kernel& kernel, const ConstMatrix& x);
  KernelMatrix kernel_;
  Cholesky cholesky_;
  Eigen::MatrixXd covariance_, whitened_, alpha_, inverse_, g_;
};

/// K = Q + Λ with Q = K_fu K_uu⁻¹ K_uf and Λ block diagonal, in whitened form: with Q = Vᵀ V, Λ = R Rᵀ, W = V R⁻ᵀ and
/// A = I + W Wᵀ, ln|K| = ln|Λ| + ln|A|. O(N k²). The types derived from it say what Λ is.
/// Frames are columns, and taken a block at a time, which is what stays in the processor's cache.
class LowRankLikelihood : public GpLikelihood {
 public:
  bool has_inducing() const final { return true; }
  double evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                  GpGradient* gradient) final;
  GaussianProcess posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                            const ConstMatrix& y) final;

 protected:
  /// n frames, from `first`.
  struct Block {
    Eigen::Index first = 0, n = 0;
    KernelMatrix cross;       // K_uf
    Eigen::MatrixXd w;        // V = Lu⁻¹ K_uf, then W
    Eigen::MatrixXd outputs;  // Yᵀ, then Yᵀ R⁻ᵀ
    // Where Λ is diagonal: the diagonals of k(X, X) − Q, Λ, R⁻¹ and the derivative by the first.
    Eigen::VectorXd conditional, lambda, inverse_root, slope;
    // Where Λ is more: k(X, X), Λ, its factor, and the derivatives by Λ and by what it is beside R, Rᵀ(dL/dΛ)R.
    KernelMatrix own;
    Eigen::MatrixXd covariance, g, whitened_g;
    Cholesky factor;
  };

  /// Lengths of the blocks that N frames are taken in.
  virtual const std::vector<Eigen::Index>& lengths(Eigen::Index n) = 0;
  /// Computes Λ of a block and brings V to W and the outputs, Yᵀ, to Yᵀ R⁻ᵀ; returns −½ D ln|Λ| and whatever else the
  /// type adds to ln p.
  virtual double condition(const Kernel& kernel, const ConstMatrix& x, Block& block) = 0;
  /// M ← M R⁻¹.
  virtual void unwhiten(const Block& block, MatrixView m) const = 0;
  /// From ρ = αᵀ R, α = K⁻¹Y, and P = −D A⁻¹ W, which give the derivative by Λ, ½R⁻ᵀ(ρᵀρ − D I − WᵀP)R⁻¹, adds to those
  /// by the block's inputs and the kernel's parameters. Where Λ depends on V, sets `t` to what V gets from it, T R⁻¹,
  /// and returns true.
  virtual bool differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block, const ConstMatrix& rho,
                             const ConstMatrix& p, MatrixView t, MatrixView x_gradient, VectorView logs) = 0;

 private:
  void divide(Eigen::Index n);
  double factorise(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y);
  void add_gradient(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, GpGradient& gradient);

  std::vector<Block> blocks_;
  KernelMatrix kuu_;
  Cholesky lu_, la_;
  Eigen::MatrixXd a_, c_, b_;                                // A, La⁻¹ W R⁻¹Y, La⁻ᵀ c
  Eigen::MatrixXd lu_inverse_, la_inverse_, a_inverse_, e_;  // the third −D A⁻¹; (dL/dV) Vᵀ
  Eigen::MatrixXd lu_inverse_transposed_, b_transposed_;     // products with what lies transposed in memory are slower
  Eigen::MatrixXd cross_, rho_, p_, t_;                      // of one block
  Eigen::MatrixXd uu_gradient_;
};

/// A low-rank likelihood whose Λ is diagonal; types differ in what they make of the conditional variances
/// c_n = k(x_n, x_n) − q(x_n, x_n), which are never below 0.
class DiagonalLikelihood : public LowRankLikelihood {
 protected:
  /// Λ from c and the variance of the noise; returns what is added to ln p for each output dimension.
  virtual double noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const = 0;
  /// From the derivative by Λ that by c, in its place: `slope`; returns that by the variance of the noise.
  virtual double noise_gradient(const Eigen::VectorXd& conditional, double white, double outputs,
                                Eigen::VectorXd& slope) const = 0;

 private:
  const std::vector<Eigen::Index>& lengths(Eigen::Index n) final;
  double condition(const Kernel& kernel, const ConstMatrix& x, Block& block) final;
  void unwhiten(const Block& block, MatrixView m) const final;
  bool differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block, const ConstMatrix& rho,
                     const ConstMatrix& p, MatrixView t, MatrixView x_gradient, VectorView logs) final;

  std::vector<Eigen::Index> lengths_;
};

/// Deterministic training conditional (Seeger, Williams and Lawrence 2003): Λ = white·I.
class DtcLikelihood : public DiagonalLikelihood {
  double noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const override;
  double noise_gradient(const Eigen::VectorXd& conditional, double white, double outputs,
                        Eigen::VectorXd& slope) const override;
};

/// Fully independent training conditional (Snelson and Ghahramani 2006): Λ = diag(k(X, X) − Q) + white·I.
class FitcLikelihood : public DiagonalLikelihood {
  double noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const override;
  double noise_gradient(const Eigen::VectorXd& conditional, double white, double outputs,
                        Eigen::VectorXd& slope) const override;
};

/// The lower bound of Titsias (2009): that of DTC less D/(2·white) · tr(k(X, X) − Q). Not above the full density.
class VariationalLikelihood : public DiagonalLikelihood {
  double noise(const Eigen::VectorXd& conditional, double white, Eigen::VectorXd& lambda) const override;
  double noise_gradient(const Eigen::VectorXd& conditional, double white, double outputs,
                        Eigen::VectorXd& slope) const override;
};

/// Partially independent training conditional (Quiñonero-Candela and Rasmussen 2005):
/// Λ = blockdiag(k(X, X) − Q) + white·I.
class PitcLikelihood : public LowRankLikelihood {
 public:
  /// Lengths of the blocks, which sum to N; see blocks_within().
  explicit PitcLikelihood(std::vector<Eigen::Index> blocks) : lengths_(std::move(blocks)) {}

 private:
  const std::vector<Eigen::Index>& lengths(Eigen::Index n) override;
  double condition(const Kernel& kernel, const ConstMatrix& x, Block& block) override;
  void unwhiten(const Block& block, MatrixView m) const override;
  bool differentiate(const Kernel& kernel, const ConstMatrix& x, Block& block, const ConstMatrix& rho,
                     const ConstMatrix& p, MatrixView t, MatrixView x_gradient, VectorView logs) override;

  std::vector<Eigen::Index> lengths_;
};

/// Sequences cut into blocks of at most `most` frames, of one sequence each and as equal as may be.
std::vector<Eigen::Index> blocks_within(const std::vector<std::int64_t>& sequences, Eigen::Index most);

}  // namespace talkgraph
