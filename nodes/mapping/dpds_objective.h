#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "nodes/latent/objective.h"

namespace talkgraph {

/// The state of every frame of the training sequences, as numbers below K.
struct StateRuns {
  std::vector<std::vector<Eigen::Index>> sequences;
  Eigen::Index states = 0;  ///< K
};

/// Negative log-likelihood of one dimension of a deterministic process dynamical system as a function of A, one
/// parameter a state: μ, ν and Γ are those that are likeliest given A. Frames are linear in μ and ν, which are least
/// squares; so the derivatives are those at fixed μ and ν (variable projection).
class DpdsObjective : public Objective {
 public:
  /// `frames` are N values, sequence after sequence; `least_noise` bounds Γ from below. With a
  /// `bound` above 0 the parameters are atanh(A / bound), so that |A| stays below it. All that is given must outlive
  /// the objective.
  DpdsObjective(const StateRuns& runs, const Eigen::VectorXd& frames, double least_noise, double bound);

  Eigen::Index size() const override { return runs_.states; }
  bool evaluate(const Eigen::VectorXd& parameters, double& cost, Eigen::VectorXd* gradient) override;
  std::string name(Eigen::Index parameter) const override { return "A of state " + std::to_string(parameter); }

  /// Of the last evaluation. A state that begins no sequence has μ, and one that no step leads to has ν, of 0.
  const Eigen::VectorXd& prediction() const { return prediction_; }
  const Eigen::VectorXd& first() const { return first_; }
  const Eigen::VectorXd& offset() const { return offset_; }
  double noise() const { return noise_; }

 private:
  bool solve();
  Eigen::VectorXd path(const std::vector<Eigen::Index>& states) const;

  const StateRuns& runs_;
  const Eigen::VectorXd& frames_;
  double least_noise_;
  double bound_;
  std::vector<std::vector<Eigen::Index>> unknowns_;  ///< of each sequence: μ below K, ν from K on
  Eigen::VectorXd prediction_, first_, offset_;
  double noise_ = 0;
};

}  // namespace talkgraph
