#pragma once

#include <Eigen/Core>
#include <vector>

#include "nodes/types/appearance_model.h"
#include "nodes/types/face_track.h"

namespace talkgraph {

Eigen::VectorXd flatten(const Shape& shape);  ///< x0, y0, x1, y1 ...
Shape unflatten(const Eigen::VectorXd& values);

Shape transform(const Pose& pose, const Shape& shape);
/// The pose that applies `inner` first.
Pose compose(const Pose& outer, const Pose& inner);
/// The pose that undoes another, whose scale is not 0.
Pose inverse(const Pose& pose);

/// Moves of the points under small changes of pose: scaling, rotation and the two shifts, a column each (2n × 4).
Eigen::MatrixXd pose_directions(const Shape& shape);

/// Similarity that carries `from` closest to `to` in (weighted) least squares.
/// Points that all coincide give a translation.
Pose align(const Shape& from, const Shape& to, const Eigen::VectorXd& weights);
Pose align(const Shape& from, const Shape& to);

struct Aligned {
  Shape mean;                 ///< centred, of the wanted width
  std::vector<Shape> shapes;  ///< each carried onto the mean
  std::vector<Pose> poses;    ///< from the mean's frame back: they carry each of `shapes` to the given one
};
/// Generalised Procrustes alignment (docs/method.md §2). The mean keeps the average
/// orientation of the shapes; `width` is its extent in x.
Aligned procrustes(const std::vector<Shape>& shapes, double width);

/// Delaunay triangulation of the points' convex hull, counting on a tiny fixed
/// perturbation where four points lie on one circle. Throws std::runtime_error
/// if there is no triangle.
Triangles delaunay(const Shape& points);

/// The pixels inside the triangles of a shape, at `scale` raster pixels
/// per unit, with a margin of one pixel.
Raster make_raster(const Shape& shape, const Triangles& triangles, double scale);

/// x' = a x + b y + c, y' = d x + e y + f
struct Affine {
  float a, b, c, d, e, f;
};
/// The affine map of each triangle of `from` to that of `to`; the identity
/// where a triangle of `from` has no area.
std::vector<Affine> affine_maps(const Shape& from, const Shape& to, const Triangles& triangles);

}  // namespace talkgraph
