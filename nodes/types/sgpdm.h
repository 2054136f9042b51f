#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// k(a, b) = variance · exp(−inverse_width/2 · |a − b|²).
struct RbfTerm {
  double variance = 1;
  double inverse_width = 1;
};
/// k(a, b) = variance · exp(−½ Σ_i inverse_widths_i (a_i − b_i)²): a dimension of inverse width 0 does not matter.
struct ArdTerm {
  double variance = 1;
  Eigen::VectorXd inverse_widths;  ///< one a dimension
};
/// k(a, b) = variance · a·b.
struct LinearTerm {
  double variance = 1;
};
/// k(a, b) = variance.
struct BiasTerm {
  double variance = 1;
};
/// Noise: variance on the diagonal of k(X, X), nothing elsewhere; it stays above `floor`.
struct WhiteTerm {
  double variance = 0.1;
  double floor = 0;
};
using KernelTerm = std::variant<RbfTerm, ArdTerm, LinearTerm, BiasTerm, WhiteTerm>;

/// A covariance function: the sum of its terms.
struct Kernel {
  std::vector<KernelTerm> terms;
};
void fields(Archive& ar, Kernel& k);

/// What prediction needs of a trained Gaussian process, in scaled output units:
/// mean k(x, basis)·weights, variance k(x, x) + white − k(x, basis)·reduction·k(basis, x).
/// Both the full process and the sparse approximations take this form. Entries of
/// the reduction grow as the inverse of the basis' covariance; its root, which loses
/// half the digits of it, takes its place where there is one.
struct GaussianProcess {
  Kernel kernel;
  Eigen::MatrixXd basis;      ///< K × d: training inputs, or inducing points
  Eigen::MatrixXd weights;    ///< K × D
  Eigen::MatrixXd reduction;  ///< K × K, symmetric; empty where there is a root
  Eigen::MatrixXd root;       ///< K × K, reduction = root·rootᵀ; may be empty
  Eigen::RowVectorXd mean;    ///< of the outputs, 1 × D
  Eigen::RowVectorXd scale;   ///< of the outputs, 1 × D: output = mean + scale · scaled output
};
void fields(Archive& ar, GaussianProcess& g);

/// φ_h(y) = tanh(y · weights + bias): the hidden units of a perceptron.
struct HiddenUnits {
  Eigen::MatrixXd weights;  ///< D × H
  Eigen::RowVectorXd bias;  ///< 1 × H
};
/// φ_k(y) = exp(−½ Σ_d inverse_widths_d (y_d − centres_kd)²): kernel-based regression.
struct RbfUnits {
  Eigen::MatrixXd centres;            ///< K × D, the training frames
  Eigen::RowVectorXd inverse_widths;  ///< 1 × D
};
/// A back-constraint: latent points as a function of observed frames, x = b(y) = φ(y) · weights + bias.
struct BackConstraint {
  std::variant<HiddenUnits, RbfUnits> units;
  Eigen::MatrixXd weights;  ///< H × d
  Eigen::RowVectorXd bias;  ///< 1 × d
};
void fields(Archive& ar, BackConstraint& b);

/// How latent points follow each other.
enum class DynamicsForm {
  absolute,    ///< x_t = h(x_{t−1}) + ε
  difference,  ///< x_t = x_{t−1} + h(x_{t−1}) + ε
  time,        ///< x_t = h(t) + ε, t = 0, 1, ... the frame's number in its window
  phase        ///< x_t = h((t + ½)/T) + ε, the share of its window of T frames
};
/// Whether the dynamics know when a latent point is, and not where the one before was.
constexpr bool is_timed(DynamicsForm form) { return form == DynamicsForm::time || form == DynamicsForm::phase; }

/// A shared Gaussian process dynamical model of one state (docs/method.md §4): audio and
/// visual features are two processes of one latent trajectory. Without
/// dynamics, for windows of one frame, it is an SGPLVM.
struct Sgpdm {
  std::string label;
  Eigen::MatrixXd latents;                  ///< N × d, windows one after the other
  std::vector<std::int64_t> lengths;        ///< of the windows; they sum to N
  Eigen::MatrixXd audio_frames;             ///< N × D_Y, scaled: for nearest neighbours
  GaussianProcess audio;                    ///< f: X -> Y
  GaussianProcess visual;                   ///< g: X -> Z
  std::optional<GaussianProcess> dynamics;  ///< h, as its form has it
  DynamicsForm form = DynamicsForm::absolute;
  std::optional<BackConstraint> back_constraint;  ///< b: Y -> X, of scaled frames
  double dynamics_bias = 1;                       ///< weight of the dynamics in sequence optimisation
  double first_variance = 1;                      ///< of the Gaussian prior of a window's first latent point
  double log_likelihood = 0;                      ///< training objective reached, natural logarithm
  std::int64_t iterations = 0;                    ///< of the optimiser
  double jitter = 0;                              ///< largest share of the mean variance added to a factorised matrix
  std::vector<double> trace;                      ///< the objective at the start and after each iteration
  std::string ended;                              ///< why training stopped: "converged", "iteration limit" ...
};
template <>
inline constexpr PortType port_type<Sgpdm>{"Sgpdm", 3};
void fields(Archive& ar, Sgpdm& s);

}  // namespace talkgraph
