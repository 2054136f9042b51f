#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <opencv2/core.hpp>

namespace talkgraph {

/// The smoothest field over a region that has given values on the region's
/// border: Laplace's equation, factorised once.
class Membrane {
 public:
  /// `region` is 8-bit, not 0 inside.
  explicit Membrane(const cv::Mat& region);
  /// Of the border's values in a 32-bit picture of three channels; 0 outside the region.
  cv::Mat operator()(const cv::Mat& values) const;

 private:
  std::vector<cv::Point> border_, inner_;
  Eigen::SparseMatrix<double> from_border_;  ///< inner × border: which border pixels an inner one touches
  std::shared_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> solver_;
};

}  // namespace talkgraph
