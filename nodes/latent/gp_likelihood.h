#pragma once

#include <Eigen/Core>
#include <memory>

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
/// approximation of K; evaluating uses its memory again.
class GpLikelihood {
 public:
  virtual ~GpLikelihood() = default;
  /// Whether inducing points are used; where not, `u` is ignored and may be empty.
  virtual bool has_inducing() const = 0;
  /// X is N × d, U k × d, Y N × D. Throws FactorisationError.
  virtual double evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                          GpGradient* gradient) = 0;
  /// Basis, weights and reduction of the process given the data (scale and mean stay empty).
  virtual GaussianProcess posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                                    const ConstMatrix& y) = 0;
  /// Largest jitter share used since the start.
  double jitter() const { return jitter_; }

 protected:
  void note(const Cholesky& c) { jitter_ = std::max(jitter_, c.jitter()); }

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

/// Fully independent training conditional (Snelson and Ghahramani 2006):
/// K = Q + diag(k(X, X) − Q) + white·I, Q = K_fu K_uu⁻¹ K_uf. O(N k²).
/// K_uu has `jitter` times its mean diagonal added, which is part of the model
/// (its derivative is taken).
class FitcLikelihood : public GpLikelihood {
 public:
  explicit FitcLikelihood(double jitter = 1e-6) : base_jitter_(jitter) {}
  bool has_inducing() const override { return true; }
  double evaluate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                  GpGradient* gradient) override;
  GaussianProcess posterior(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u,
                            const ConstMatrix& y) override;

 private:
  void factorise(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y);
  void differentiate(const Kernel& kernel, const ConstMatrix& x, const ConstMatrix& u, const ConstMatrix& y,
                     GpGradient& gradient);
  double base_jitter_;
  KernelMatrix kuu_, kuf_;
  Cholesky lu_, la_;
  Eigen::MatrixXd v_;        // Lu⁻¹ K_uf
  Eigen::MatrixXd vs_;       // V Λ^−½
  Eigen::MatrixXd a_;        // I + Vs Vsᵀ
  Eigen::MatrixXd ys_, c_;   // Λ^−½ Y, La⁻¹ Vs Ys
  Eigen::MatrixXd weights_;  // Lu⁻ᵀ La⁻ᵀ c
  Eigen::MatrixXd s_, p_, g_uu_, square_;
  Eigen::VectorXd k_diagonal_, lambda_, g_diagonal_;
};

}  // namespace talkgraph
