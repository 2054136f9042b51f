#pragma once

#include <Eigen/Core>

#include "graph/value.h"

namespace talkgraph {

/// Rows as a mixture of independent components: c = mean + A u (Eqn 3.38), D
/// dimensions, K ≤ D components. Over the rows learnt from, each component has
/// mean 0 and variance 1; they come in the order of the variance they bring.
struct IndependentComponents {
  Eigen::RowVectorXd mean;   ///< D
  Eigen::MatrixXd mixing;    ///< A, D × K: what one deviation of each component adds
  Eigen::MatrixXd unmixing;  ///< A⁻¹ (pseudo-inverse if K < D), K × D

  Eigen::Index count() const { return mixing.cols(); }
  Eigen::Index dimension() const { return mixing.rows(); }
  /// u of every row, T × K. Throws std::runtime_error if rows have another length than D.
  Eigen::MatrixXd of(const Eigen::MatrixXd& rows) const;
};
template <>
inline constexpr PortType port_type<IndependentComponents>{"IndependentComponents", 1};
void fields(Archive& ar, IndependentComponents& c);

}  // namespace talkgraph
