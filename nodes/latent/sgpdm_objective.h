#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/latent/back_constraint.h"
#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/maximand.h"

namespace talkgraph {

/// One Gaussian process of the joint model while it is trained.
struct GpStream {
  std::string name;  ///< "audio", "visual", "dynamics"
  Kernel kernel;
  Eigen::MatrixXd inducing;  ///< k × d; without rows where the likelihood has none
  std::unique_ptr<GpLikelihood> likelihood;
  double weight = 1;  ///< of its log-likelihood
};

/// One observed stream: `process` is that of values / scale.
struct Observations {
  GpStream process;
  Eigen::MatrixXd values;    ///< N × D, centred
  Eigen::RowVectorXd scale;  ///< 1 × D
  bool learn_scale = false;  ///< the scale of dimensions that vary is optimised too
};

/// What the joint model is trained on, and from where: one observed stream makes
/// a GPLVM or GPDM, two an SGPLVM or SGPDM.
struct SgpdmProblem {
  std::vector<Observations> observations;
  std::vector<std::int64_t> lengths;  ///< of the sequences, summing to N
  Eigen::MatrixXd latents;            ///< N × d, start values; with a back-constraint only d counts
  std::optional<BackProjection> back_constraint;
  std::optional<GpStream> dynamics;
  DynamicsForm form = DynamicsForm::absolute;
  double dynamics_weight = 1;            ///< λ_dyn, of the dynamics and of the prior of the first points
  std::optional<double> first_variance;  ///< σ₁²; without it the dynamics' noise (the source's β_dyn⁻¹), or no prior
  double prior_deviation = 0;      ///< of a normal prior on log kernel parameters about their start values; 0: none
  std::vector<std::string> fixed;  ///< "latents", "inducing", "<stream>.<kernel parameter>"
};

/// Joint log-likelihood (Eqn 4.69), a true density of the observations
/// in their own units, as a function of latent points (or the back-constraint's
/// parameters), inducing points, log scales that are learnt, and log kernel
/// parameters, in that order; matrices column by column, the dynamics after all
/// observed streams.
class SgpdmObjective : public Maximand {
 public:
  /// Throws std::invalid_argument if `fixed` names what is not there.
  explicit SgpdmObjective(SgpdmProblem problem);
  SgpdmObjective(const SgpdmObjective&) = delete;

  Eigen::Index size() const override { return start_.size(); }
  std::string name(Eigen::Index parameter) const override;

  const Eigen::VectorXd& start() const { return start_; }
  void hold_noise(bool hold) override { noise_held_ = hold; }
  Eigen::MatrixXd latents(const Eigen::VectorXd& parameters);
  /// Of an observed stream, with its scale; its mean stays empty.
  GaussianProcess process(std::size_t stream, const Eigen::VectorXd& parameters);
  std::optional<GaussianProcess> dynamics(const Eigen::VectorXd& parameters);
  /// b, of frames divided by the scale that its stream started from.
  std::optional<BackConstraint> back_constraint(const Eigen::VectorXd& parameters) const;
  double first_variance(const Eigen::VectorXd& parameters);
  double jitter() const;

 private:
  struct Place {
    GpStream* stream;
    Eigen::Index inducing = 0, scale = 0, kernel = 0;  // offsets
    Observations* observed = nullptr;
    Kernel now;
    Eigen::MatrixXd outputs;
    GpGradient gradient;
    Eigen::RowVectorXd inverse_scale;
  };
  using View = Eigen::Map<const Eigen::MatrixXd>;

  double compute(const Eigen::VectorXd& parameters, Eigen::VectorXd* gradient) override;
  bool timed() const { return problem_.dynamics && is_timed(problem_.form); }
  void find_steps();
  void lay_out();
  void fix();
  View inducing_view(const Place& place, const Eigen::VectorXd& p) const;
  void place_latents(const Eigen::VectorXd& p);
  void place_outputs(Place& place, const Eigen::VectorXd& p) const;
  void gather_steps();
  double stream_likelihood(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x, Eigen::VectorXd* gradient);
  double observed_likelihood(Place& place, const Eigen::VectorXd& p, Eigen::VectorXd* gradient);
  double dynamics_likelihood(Place& place, const Eigen::VectorXd& p, Eigen::VectorXd* gradient);
  double first_points(const Eigen::VectorXd& p, Eigen::VectorXd* gradient);
  double hyperprior(const Eigen::VectorXd& p, Eigen::VectorXd* gradient) const;
  GaussianProcess posterior(Place& place, const Eigen::VectorXd& p, const ConstMatrix& x);

  SgpdmProblem problem_;
  std::vector<Place> places_;  // observed streams, then dynamics
  Eigen::Index latent_size_ = 0;
  Eigen::VectorXd start_, free_, noise_;  // of the last two, 0 where a parameter is held
  bool noise_held_ = false;
  std::vector<Eigen::Index> from_, to_, first_;
  Eigen::MatrixXd x_, x_gradient_, in_;
};

}  // namespace talkgraph
