#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/objective.h"

namespace talkgraph {

/// One Gaussian process of the joint model while it is trained.
struct GpStream {
  std::string name;  ///< "audio", "visual", "dynamics"
  Kernel kernel;
  Eigen::MatrixXd inducing;  ///< k × d; without rows where the likelihood has none
  std::unique_ptr<GpLikelihood> likelihood;
  double weight = 1;  ///< of its log-likelihood
};

/// What the joint model is trained on, and from where.
struct SgpdmProblem {
  Eigen::MatrixXd audio, visual;      ///< N × D, scaled
  double log_scale = 0;               ///< weighted Σ N·ln s over both streams, subtracted from the likelihood
  std::vector<std::int64_t> lengths;  ///< of the windows, summing to N
  Eigen::MatrixXd latents;            ///< N × d, start values
  GpStream f, g;
  std::optional<GpStream> h;
  double dynamics_weight = 1;      ///< λ_dyn, of h and of the prior of the first points
  double first_variance = 1;       ///< σ₁²
  double prior_deviation = 0;      ///< of a normal prior on log kernel parameters about their start values; 0: none
  std::vector<std::string> fixed;  ///< "latents", "inducing", "<stream>.<kernel parameter>"
};

/// Negative joint log-likelihood of an SGPDM (Eqn 4.69) as a function of
/// latents, inducing points and log kernel parameters, in that order; matrices
/// column by column, streams audio, visual, dynamics.
class SgpdmObjective : public Objective {
 public:
  /// Throws std::invalid_argument if `fixed` names what is not there.
  explicit SgpdmObjective(SgpdmProblem problem);
  SgpdmObjective(const SgpdmObjective&) = delete;

  Eigen::Index size() const override { return start_.size(); }
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) override;

  const Eigen::VectorXd& start() const { return start_; }
  /// Throws FactorisationError where evaluate() returns false.
  double log_likelihood(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient);

  Eigen::MatrixXd latents(const Eigen::VectorXd& parameters) const;
  GaussianProcess audio(const Eigen::VectorXd& parameters);
  GaussianProcess visual(const Eigen::VectorXd& parameters);
  std::optional<GaussianProcess> dynamics(const Eigen::VectorXd& parameters);
  double jitter() const;

 private:
  struct Place {
    GpStream* stream;
    Eigen::Index inducing, kernel;  // offsets
    GpGradient gradient;
    Kernel now;
  };
  using View = Eigen::Map<const Eigen::MatrixXd>;

  View latent_view(const Eigen::VectorXd& p) const;
  View inducing_view(const Place& place, const Eigen::VectorXd& p) const;
  double stream_likelihood(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x, const ConstMatrix& y,
                           Eigen::VectorXd* gradient);
  double first_points(const View& x, double weight, Eigen::VectorXd* gradient) const;
  double hyperprior(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) const;
  void gather(const View& x);
  GaussianProcess posterior(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x, const ConstMatrix& y);
  void fix();

  SgpdmProblem problem_;
  std::vector<Place> places_;
  Eigen::VectorXd start_, free_;
  std::vector<Eigen::Index> from_, to_, first_;
  Eigen::MatrixXd in_, out_;
};

}  // namespace talkgraph
