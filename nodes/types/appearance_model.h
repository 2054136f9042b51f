#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "graph/value.h"
#include "nodes/types/shape.h"

namespace talkgraph {

/// Rows of three point indices.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3>;

/// A large matrix that copies of a model share.
using SharedMatrix = std::shared_ptr<const Eigen::MatrixXf>;

/// The pixels inside the shape that textures are warped to at one resolution, row
/// by row, and the triangle that each lies in. Raster position = (model position - origin) · scale.
struct Raster {
  int width = 0, height = 0;
  double scale = 1;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Shape points;  ///< of that shape, raster positions
  std::vector<int> x, y, triangle;

  Eigen::Index size() const { return static_cast<Eigen::Index>(x.size()); }
};
void fields(Archive& ar, Raster& r);

/// What fitting needs at one level of the pyramid. Textures hold blue, green
/// and red of every pixel of the raster, 3P values.
struct FitLevel {
  Raster raster;
  SharedMatrix mean;        ///< 3P × 1, normalised mean texture
  SharedMatrix appearance;  ///< 3P × modes, normalised texture per unit of c
  SharedMatrix change;      ///< 3P × (k_s + 4), normalised texture per unit of shape mode and pose (Eqn 3.21)
};
void fields(Archive& ar, FitLevel& f);

/// Active appearance model of a face (docs/method.md §2). Model frame: the mean shape is
/// centred on the origin; one unit is one pixel of the finest raster. A texture
/// is normalised to mean 0 and norm 1 over its 3P values (Eqn 3.13).
struct AppearanceModel {
  std::string scheme;  ///< name of the point scheme
  Shape mean_shape;    ///< n × 2
  Triangles triangles;
  Eigen::MatrixXd shape_modes;  ///< 2n × k_s, unit columns; rows x0, y0, x1, y1 ...
  Eigen::VectorXd shape_variances;
  SharedMatrix texture_modes;  ///< 3P × k_g, unit columns
  Eigen::VectorXd texture_variances;
  double shape_weight = 1;         ///< r of W_s = r·I
  Eigen::MatrixXd combined_modes;  ///< (k_s + k_g) × k_c, unit columns
  Eigen::VectorXd combined_variances;
  Eigen::MatrixXd shape_per_mode;  ///< 2n × k_c: shape per unit of c
  double texture_offset = 0;       ///< average mean of the prototypes' textures, grey levels
  double texture_gain = 1;         ///< average norm of the prototypes' centred textures
  double residual = 0;             ///< RMS texture error over the prototypes, grey levels
  double picture_scale = 1;        ///< average scale of the prototypes' poses
  std::vector<FitLevel> levels;    ///< finest first

  Eigen::Index modes() const { return combined_variances.size(); }
  Eigen::Index points() const { return mean_shape.rows(); }
  /// Shape of the parameters c, model frame (Eqn 3.18).
  Shape shape(const Eigen::VectorXd& c) const;
  /// Normalised texture of the parameters c at a level (Eqn 3.18).
  Eigen::VectorXf texture(const Eigen::VectorXd& c, std::size_t level = 0) const;
};
template <>
inline constexpr PortType port_type<AppearanceModel>{"AppearanceModel", 2};
void fields(Archive& ar, AppearanceModel& m);

}  // namespace talkgraph
