#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace talkgraph {

struct GaussianMixture;
struct GaussianProcess;
struct Scaling;

/// Checks a model that was loaded, whose file may be damaged: who uses it relies on members that fit together and are
/// finite. All members throw std::runtime_error, naming model and member.
class StoredModel {
 public:
  /// `name` is what a reader calls the model ("GPDM", "state \"a\"").
  explicit StoredModel(std::string name) : name_(std::move(name)) {}
  void require(bool holds, const std::string& member, const std::string& what) const;
  /// Finite, and of that size.
  void matrix(const std::string& member, const Eigen::Ref<const Eigen::MatrixXd>& m, Eigen::Index rows,
              Eigen::Index columns) const;
  /// Finite, n × n, or n × 1 if it is diagonal.
  void covariance(const std::string& member, const Eigen::MatrixXd& m, Eigen::Index n) const;
  /// Finite, none below 0 and not all 0.
  void weights(const std::string& member, const Eigen::Ref<const Eigen::MatrixXd>& w) const;
  /// Finite, of that size, all above 0.
  void variances(const std::string& member, const Eigen::MatrixXd& v, Eigen::Index rows, Eigen::Index columns) const;
  /// Rising, so that each is there once and can be looked up.
  void sorted(const std::string& member, const std::vector<std::string>& names) const;
  void not_negative(const std::string& member, double value) const;
  void positive(const std::string& member, double value) const;

  void process(const std::string& member, const GaussianProcess& gp, Eigen::Index inputs, Eigen::Index outputs) const;
  void mixture(const std::string& member, const GaussianMixture& mixture, Eigen::Index dimension) const;
  void mixtures(const std::string& member, const std::vector<GaussianMixture>& of_states, Eigen::Index states,
                Eigen::Index dimension) const;
  void scaling(const std::string& member, const Scaling& scaling, Eigen::Index dimension) const;

 private:
  std::string name_;
};

}  // namespace talkgraph
