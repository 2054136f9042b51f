#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "nodes/latent/sgpdm.h"

namespace talkgraph {

/// Outputs of a stream, centred and scaled, of which some may be missing. Outputs that are missing in the same rows
/// form a group, and rows that have the same groups a class; where nothing is missing there is one of each.
struct ObservedOutputs {
  struct Class {
    std::vector<Eigen::Index> rows;
    std::vector<std::size_t> groups;  ///< that its rows have
  };
  Eigen::MatrixXd values;          ///< N × D, zero where missing
  Eigen::RowVectorXd mean, scale;  ///< 1 × D, of what is there
  std::vector<std::vector<Eigen::Index>> groups;
  std::vector<Class> classes;  ///< rows without any output are in none
  bool varies = false;

  Eigen::Index rows() const { return values.rows(); }
  Eigen::Index outputs() const { return values.cols(); }
};

/// NaN marks a missing value. Scales are as output_scale() has them. Throws std::runtime_error, naming `stream` and
/// the output, if a value is infinite or an output is missing in every row.
ObservedOutputs observed_outputs(const Eigen::MatrixXd& values, OutputScaling scaling, const std::string& stream);

}  // namespace talkgraph
