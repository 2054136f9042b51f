#pragma once

#include <Eigen/Core>

#include "graph/archive.h"

namespace talkgraph {

/// What is taken off features before a model sees them, and put back behind it.
struct Scaling {
  Eigen::RowVectorXd mean;
  Eigen::RowVectorXd deviation;  ///< 0 of a dimension that does not vary
};
void fields(Archive& ar, Scaling& s);

}  // namespace talkgraph
