#include "nodes/face/geometry.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "graph/random.h"

namespace talkgraph {
namespace {

using Point = Eigen::Vector2d;
using RowMajorShape = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

double doubled_area(const Point& a, const Point& b, const Point& c) { return cross(b - a, c - a); }

Shape centred(const Shape& shape) { return shape.rowwise() - shape.colwise().mean(); }

double extent_x(const Shape& shape) { return shape.col(0).maxCoeff() - shape.col(0).minCoeff(); }

/// Points lifted to a paraboloid; its lower hull is the Delaunay triangulation.
/// The perturbation makes cocircular points generic, the same on every machine.
Eigen::VectorXd lift(const Shape& points) {
  Random random(1);
  Eigen::VectorXd z = points.rowwise().squaredNorm();
  const double size = z.maxCoeff();
  for (auto& value : z) value += 1e-9 * size * random.uniform();
  return z;
}

bool is_lower_face(const Shape& p, const Eigen::VectorXd& z, int i, int j, int k) {
  const Eigen::Vector3d a(p(i, 0), p(i, 1), z(i)), b(p(j, 0), p(j, 1), z(j)), c(p(k, 0), p(k, 1), z(k));
  Eigen::Vector3d normal = (b - a).cross(c - a);
  if (normal.z() < 0) normal = -normal;
  for (int m = 0; m < p.rows(); ++m)
    if (m != i && m != j && m != k && normal.dot(Eigen::Vector3d(p(m, 0), p(m, 1), z(m)) - a) < 0) return false;
  return true;
}

bool inside(const Point& p, const Point& a, const Point& b, const Point& c) {
  const double area = doubled_area(a, b, c);
  const double sign = area < 0 ? -1 : 1, slack = -1e-9 * std::abs(area);
  return sign * doubled_area(a, b, p) >= slack && sign * doubled_area(b, c, p) >= slack &&
         sign * doubled_area(c, a, p) >= slack;
}

/// Marks the pixels of one triangle that no earlier triangle has taken.
void mark(const Point& a, const Point& b, const Point& c, int triangle, Eigen::MatrixXi& taken) {
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()}))));
  const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({a.y(), b.y(), c.y()}))));
  const int x1 =
      std::min(static_cast<int>(taken.cols()) - 1, static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()}))));
  const int y1 =
      std::min(static_cast<int>(taken.rows()) - 1, static_cast<int>(std::floor(std::max({a.y(), b.y(), c.y()}))));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      if (taken(y, x) < 0 && inside(Point(x, y), a, b, c)) taken(y, x) = triangle;
}

}  // namespace

Eigen::VectorXd flatten(const Shape& shape) {
  const RowMajorShape rows = shape;
  return Eigen::Map<const Eigen::VectorXd>(rows.data(), rows.size());
}

Shape unflatten(const Eigen::VectorXd& values) {
  return Eigen::Map<const RowMajorShape>(values.data(), values.size() / 2, 2);
}

Shape transform(const Pose& pose, const Shape& shape) {
  const double a = pose.scale * std::cos(pose.angle), b = pose.scale * std::sin(pose.angle);
  Shape out(shape.rows(), 2);
  out.col(0) = (a * shape.col(0) - b * shape.col(1)).array() + pose.dx;
  out.col(1) = (b * shape.col(0) + a * shape.col(1)).array() + pose.dy;
  return out;
}

Pose compose(const Pose& outer, const Pose& inner) {
  const double a = outer.scale * std::cos(outer.angle), b = outer.scale * std::sin(outer.angle);
  return {outer.scale * inner.scale, outer.angle + inner.angle, a * inner.dx - b * inner.dy + outer.dx,
          b * inner.dx + a * inner.dy + outer.dy};
}

Pose inverse(const Pose& pose) {
  const double scale = 1 / pose.scale, a = scale * std::cos(pose.angle), b = -scale * std::sin(pose.angle);
  return {scale, -pose.angle, b * pose.dy - a * pose.dx, -b * pose.dx - a * pose.dy};
}

Eigen::MatrixXd pose_directions(const Shape& shape) {
  Eigen::MatrixXd d(2 * shape.rows(), 4);
  for (Eigen::Index i = 0; i < shape.rows(); ++i) {
    d.row(2 * i) << shape(i, 0), -shape(i, 1), 1, 0;
    d.row(2 * i + 1) << shape(i, 1), shape(i, 0), 0, 1;
  }
  return d;
}

Pose align(const Shape& from, const Shape& to, const Eigen::VectorXd& weights) {
  const double total = weights.sum();
  const Eigen::RowVector2d from_mean = weights.transpose() * from / total, to_mean = weights.transpose() * to / total;
  const Shape x = from.rowwise() - from_mean, y = to.rowwise() - to_mean;
  const double spread = weights.dot(x.rowwise().squaredNorm());
  double a = 1, b = 0;
  if (spread > 0) {
    a = weights.dot((x.array() * y.array()).matrix().rowwise().sum()) / spread;
    b = weights.dot((x.col(0).array() * y.col(1).array() - x.col(1).array() * y.col(0).array()).matrix()) / spread;
  }
  return {std::hypot(a, b), std::atan2(b, a), to_mean.x() - a * from_mean.x() + b * from_mean.y(),
          to_mean.y() - b * from_mean.x() - a * from_mean.y()};
}

Pose align(const Shape& from, const Shape& to) { return align(from, to, Eigen::VectorXd::Ones(from.rows())); }

Aligned procrustes(const std::vector<Shape>& shapes, double width) {
  Shape mean = Shape::Zero(shapes.front().rows(), 2);
  for (const auto& shape : shapes) mean += centred(shape);
  const auto rescale = [&] {
    mean = centred(mean);
    const double extent = extent_x(mean);
    if (!(extent > 0)) throw std::runtime_error("the landmarks of the prototypes have no extent: all points coincide");
    mean *= width / extent;
  };
  rescale();
  Aligned out;
  for (int round = 0; round < 100; ++round) {
    const Shape before = mean;
    out.shapes.clear();
    mean.setZero();
    for (const auto& shape : shapes) {
      out.shapes.push_back(transform(align(shape, before), shape));
      mean += out.shapes.back();
    }
    rescale();
    mean = transform(Pose{1, align(mean, before).angle, 0, 0}, mean);
    if ((mean - before).cwiseAbs().maxCoeff() < 1e-9 * width) break;
  }
  out.mean = mean;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Pose onto_mean = align(shapes[i], mean);
    out.shapes[i] = transform(onto_mean, shapes[i]);
    out.poses.push_back(inverse(onto_mean));
  }
  return out;
}

Triangles delaunay(const Shape& points) {
  const Shape p = centred(points);
  const Eigen::VectorXd z = lift(p);
  const double size = p.rowwise().squaredNorm().maxCoeff();
  const int n = static_cast<int>(p.rows());
  std::vector<Eigen::RowVector3i> found;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k)
        if (std::abs(doubled_area(p.row(i), p.row(j), p.row(k))) > 1e-6 * size && is_lower_face(p, z, i, j, k))
          found.push_back({i, j, k});
  if (found.empty()) throw std::runtime_error("the mean shape cannot be triangulated: its points lie on a line");
  Triangles triangles(found.size(), 3);
  for (std::size_t i = 0; i < found.size(); ++i) triangles.row(static_cast<Eigen::Index>(i)) = found[i];
  return triangles;
}

Raster make_raster(const Shape& shape, const Triangles& triangles, double scale) {
  Raster raster;
  raster.scale = scale;
  const Eigen::RowVector2d low = shape.colwise().minCoeff(), high = shape.colwise().maxCoeff();
  raster.origin = low.transpose().array() - 1 / scale;
  raster.width = static_cast<int>(std::ceil((high.x() - low.x()) * scale)) + 3;
  raster.height = static_cast<int>(std::ceil((high.y() - low.y()) * scale)) + 3;
  raster.points = (shape.rowwise() - raster.origin.transpose()) * scale;
  Eigen::MatrixXi taken = Eigen::MatrixXi::Constant(raster.height, raster.width, -1);
  for (int t = 0; t < triangles.rows(); ++t)
    mark(raster.points.row(triangles(t, 0)), raster.points.row(triangles(t, 1)), raster.points.row(triangles(t, 2)), t,
         taken);
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width; ++x)
      if (taken(y, x) >= 0) {
        raster.x.push_back(x);
        raster.y.push_back(y);
        raster.triangle.push_back(taken(y, x));
      }
  return raster;
}

std::vector<Affine> affine_maps(const Shape& from, const Shape& to, const Triangles& triangles) {
  std::vector<Affine> maps;
  maps.reserve(static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Point a = from.row(triangles(t, 0)), u = Point(from.row(triangles(t, 1))) - a,
                v = Point(from.row(triangles(t, 2))) - a;
    const Point p = to.row(triangles(t, 0)), q = Point(to.row(triangles(t, 1))) - p,
                r = Point(to.row(triangles(t, 2))) - p;
    const double area = cross(u, v);
    if (area == 0) {
      maps.push_back({1, 0, 0, 0, 1, 0});
      continue;
    }
    const double xx = (q.x() * v.y() - r.x() * u.y()) / area, xy = (r.x() * u.x() - q.x() * v.x()) / area;
    const double yx = (q.y() * v.y() - r.y() * u.y()) / area, yy = (r.y() * u.x() - q.y() * v.x()) / area;
    maps.push_back({static_cast<float>(xx), static_cast<float>(xy), static_cast<float>(p.x() - xx * a.x() - xy * a.y()),
                    static_cast<float>(yx), static_cast<float>(yy),
                    static_cast<float>(p.y() - yx * a.x() - yy * a.y())});
  }
  return maps;
}

}  // namespace talkgraph
