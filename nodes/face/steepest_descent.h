#pragma once

#include <vector>

#include "nodes/face/sampling.h"
#include "nodes/types/appearance_model.h"

namespace talkgraph {

/// How a texture changes while the picture's points move, from its own
/// gradient: the steepest-descent images of inverse compositional fitting
/// (Baker & Matthews 2004). A texture holds three channels of every pixel of the raster.
class SteepestDescent {
 public:
  SteepestDescent(const Raster& raster, const Triangles& triangles);

  /// `directions` are moves of the points of `shape`, one a column (x0, y0, x1,
  /// y1 ...), both in the same frame. Column j of `images` is the change of the
  /// texture per unit of direction j, when `texture` is what the picture shows inside `shape`.
  void operator()(const Shape& shape, const Eigen::MatrixXd& directions, const Eigen::VectorXf& texture,
                  Eigen::Ref<Eigen::MatrixXf> images) const;

 private:
  Shape points_;
  Triangles triangles_;
  std::vector<Run> runs_;
  /// Pixels beside each, itself at the edge.
  std::vector<int> left_, right_, above_, below_;
};

}  // namespace talkgraph
