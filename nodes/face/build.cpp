#include "nodes/face/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/face/geometry.h"
#include "nodes/face/pca.h"
#include "nodes/face/sampling.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

void check(const Prototypes& p) {
  if (p.shapes.empty() || p.shapes.size() != p.images.size())
    throw std::runtime_error(fmt::format(
        "{} pictures and {} sets of landmarks: a face model needs at least one picture, each with landmarks",
        p.images.size(), p.shapes.size()));
  for (std::size_t i = 0; i < p.shapes.size(); ++i) {
    if (p.images[i].pixels.type() != CV_8UC3 || p.images[i].pixels.empty())
      throw std::runtime_error(fmt::format("prototype {} is not an 8-bit colour picture", i));
    if (p.shapes[i].rows() != p.shapes[0].rows() || p.shapes[i].rows() < 3)
      throw std::runtime_error(
          fmt::format("prototype {} has {} landmarks, the first has {}; all need the same, at least 3", i,
                      p.shapes[i].rows(), p.shapes[0].rows()));
    if (!p.shapes[i].allFinite())
      throw std::runtime_error(
          fmt::format("prototype {} has a landmark that is not a number: leave such frames out", i));
  }
}

double mean_width(const std::vector<Shape>& shapes) {
  double sum = 0;
  for (const auto& s : shapes) sum += s.col(0).maxCoeff() - s.col(0).minCoeff();
  return sum / static_cast<double>(shapes.size());
}

std::vector<Pyramid> pyramids(const Prototypes& prototypes) {
  std::vector<Pyramid> out;
  for (const auto& image : prototypes.images) out.emplace_back(image.pixels);
  return out;
}

/// Those of the point scheme, else Delaunay's.
Triangles triangles_of(const std::string& scheme, const Shape& mean) {
  const auto found = find_scheme(scheme);
  return found && found->triangles.rows() > 0 ? scheme_of(scheme, mean.rows()).triangles : delaunay(mean);
}

/// The shape that textures are warped to: where the scheme knows the inner lips, the mean of the openest tenth of the
/// prototypes, whose teeth have room in it; else the mean shape.
Shape shape_of_textures(const AppearanceModel& model, std::vector<Shape> aligned) {
  const auto scheme = find_scheme(model.scheme);
  if (!scheme || scheme->points() != model.points() || !scheme->names.contains("inner_top") ||
      !scheme->names.contains("inner_bottom"))
    return model.mean_shape;
  const auto gap = [top = scheme->point("inner_top"), bottom = scheme->point("inner_bottom")](const Shape& s) {
    return s(bottom, 1) - s(top, 1);
  };
  std::stable_sort(aligned.begin(), aligned.end(), [&](const Shape& a, const Shape& b) { return gap(a) > gap(b); });
  aligned.resize((aligned.size() + 9) / 10);
  Shape sum = Shape::Zero(model.points(), 2);
  for (const Shape& shape : aligned) sum += shape;
  return sum / static_cast<double>(aligned.size());
}

struct Textures {
  Eigen::MatrixXd columns;  ///< 3P × N, normalised
  std::vector<Photometry> photometry;
};

Textures sample_all(std::vector<Pyramid>& pictures, const std::vector<Shape>& shapes, const Sampler& sample) {
  Textures out;
  Eigen::VectorXf texture;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    sample(pictures[i], shapes[i], texture);
    out.photometry.push_back(normalise(texture));
    if (out.photometry.back().gain == 0)
      throw std::runtime_error(fmt::format("prototype {} shows no face: its picture is flat inside the landmarks", i));
    if (i == 0) out.columns.resize(texture.size(), static_cast<Eigen::Index>(shapes.size()));
    out.columns.col(static_cast<Eigen::Index>(i)) = texture.cast<double>();
  }
  return out;
}

SharedMatrix share(Eigen::MatrixXf matrix) { return std::make_shared<const Eigen::MatrixXf>(std::move(matrix)); }

/// Texture change per unit of every shape parameter and of the pose, measured
/// by moving the shapes half a raster pixel both ways and averaged over the
/// prototypes. `directions` are shape changes in the model frame, one a column.
Eigen::MatrixXf texture_change(std::vector<Pyramid>& pictures, const Aligned& aligned,
                               const Eigen::MatrixXd& directions, const Sampler& sample, double scale,
                               const std::vector<Photometry>& photometry) {
  const double points = static_cast<double>(aligned.mean.rows());
  Eigen::MatrixXf change;
  Eigen::VectorXf forth, back;
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (Eigen::Index j = 0; j < directions.cols(); ++j) {
      const double h = 0.5 / scale / (directions.col(j).norm() / std::sqrt(points));
      const Shape step = unflatten(h * directions.col(j));
      sample(pictures[i], transform(aligned.poses[i], aligned.shapes[i] + step), forth);
      sample(pictures[i], transform(aligned.poses[i], aligned.shapes[i] - step), back);
      if (change.size() == 0) change.setZero(forth.size(), directions.cols());
      change.col(j) += (forth - back) * static_cast<float>(1 / (2 * h * photometry[i].gain));
    }
  return change / static_cast<float>(pictures.size());
}

/// The rest of the model once shapes and textures have been reduced.
void combine(AppearanceModel& model, const Pca& shapes, const Pca& textures, const Eigen::MatrixXd& shape_columns,
             const Eigen::MatrixXd& texture_columns, double retain, Eigen::MatrixXd& c) {
  const auto ks = shapes.variances.size(), kg = textures.variances.size();
  model.shape_weight = shapes.total > 0 && textures.total > 0 ? std::sqrt(textures.total / shapes.total) : 1;
  Eigen::MatrixXd b(ks + kg, shape_columns.cols());
  b.topRows(ks) = model.shape_weight * shapes.modes.transpose() * (shape_columns.colwise() - shapes.mean);
  b.bottomRows(kg) = textures.modes.transpose() * (texture_columns.colwise() - textures.mean);
  if (b.rows() > 0) {
    const auto combined = pca(b, retain);
    model.combined_modes = combined.modes;
    model.combined_variances = combined.variances;
  } else {
    model.combined_modes.resize(0, 0);
    model.combined_variances.resize(0);
  }
  c = model.combined_modes.transpose() * b;
  model.shape_per_mode = shapes.modes * model.combined_modes.topRows(ks) / model.shape_weight;
}

double root_mean_square_error(const AppearanceModel& model, const Textures& textures, const Eigen::MatrixXd& c) {
  double sum = 0;
  for (Eigen::Index i = 0; i < c.cols(); ++i) {
    const double gain = textures.photometry[static_cast<std::size_t>(i)].gain;
    sum += gain * gain * (model.texture(c.col(i)).cast<double>() - textures.columns.col(i)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(textures.columns.size()));
}

}  // namespace

AppearanceModel BuildAppearance::operator()(const Prototypes& prototypes, Context& context) const {
  check(prototypes);
  AppearanceModel model;
  model.scheme = prototypes.scheme;
  const auto count = static_cast<Eigen::Index>(prototypes.shapes.size());
  const auto aligned = procrustes(prototypes.shapes, std::min(width, mean_width(prototypes.shapes)));
  model.mean_shape = aligned.mean;
  model.triangles = triangles_of(model.scheme, model.mean_shape);
  auto pictures = pyramids(prototypes);

  Eigen::MatrixXd shape_columns(2 * model.points(), count);
  for (Eigen::Index i = 0; i < count; ++i) shape_columns.col(i) = flatten(aligned.shapes[static_cast<std::size_t>(i)]);
  const auto shapes = pca(shape_columns, retain_shape);
  model.mean_shape = unflatten(shapes.mean);
  model.shape_modes = shapes.modes;
  model.shape_variances = shapes.variances;
  context.progress(0.1);

  model.levels.resize(1);
  const Shape open = shape_of_textures(model, aligned.shapes);
  model.levels[0].raster = make_raster(open, model.triangles, 1);
  const auto finest = sample_all(pictures, prototypes.shapes, Sampler(model.levels[0].raster, model.triangles));
  const auto textures = pca(finest.columns, retain_texture);
  model.texture_modes = share(textures.modes.cast<float>());
  model.texture_variances = textures.variances;
  model.texture_gain = model.picture_scale = 0;
  for (const auto& p : finest.photometry) {
    model.texture_offset += p.offset / static_cast<double>(count);
    model.texture_gain += p.gain / static_cast<double>(count);
  }
  for (const auto& pose : aligned.poses) model.picture_scale += pose.scale / static_cast<double>(count);
  context.progress(0.3);

  Eigen::MatrixXd c;
  combine(model, shapes, textures, shape_columns, finest.columns, retain_combined, c);
  model.levels[0].mean = share(textures.mean.cast<float>());
  model.levels[0].appearance =
      share((textures.modes * model.combined_modes.bottomRows(textures.variances.size())).cast<float>());
  model.residual = root_mean_square_error(model, finest, c);

  Eigen::MatrixXd directions(2 * model.points(), model.shape_modes.cols() + 4);
  directions << model.shape_modes, pose_directions(model.mean_shape);
  for (int l = 0; l < levels; ++l) {
    context.check_cancelled();
    if (l > 0) model.levels.push_back({make_raster(open, model.triangles, std::exp2(-l)), {}, {}, {}});
    auto& level = model.levels[static_cast<std::size_t>(l)];
    const Sampler sample(level.raster, model.triangles);
    const auto sampled = l > 0 ? sample_all(pictures, prototypes.shapes, sample) : finest;
    if (l > 0) {
      const Eigen::VectorXd mean = sampled.columns.rowwise().mean();
      level.mean = share(mean.cast<float>());
      // c has uncorrelated rows of mean 0: regression on it is a plain product.
      level.appearance = share(((sampled.columns.colwise() - mean) * c.transpose() *
                                (static_cast<double>(count) * model.combined_variances).cwiseInverse().asDiagonal())
                                   .cast<float>());
    }
    level.change = share(texture_change(pictures, aligned, directions, sample, level.raster.scale, sampled.photometry));
    context.progress(0.3 + 0.7 * (l + 1) / levels);
  }
  return model;
}

void describe(Description<BuildAppearance>& d) {
  d.type("face.build").version(4).summary("builds an active appearance model from pictures with landmarks");
  d.source("Thesis §3.1, §3.4, Eqns 3.11-3.21; docs/method.md §2").stored();
  d.input("prototypes", "pictures with landmarks").output("model", "shape, texture and their combined modes");
  d.param("width", &BuildAppearance::width)
      .within(16, 1000)
      .unit("px")
      .doc("of the mean shape; held to the prototypes' own average width, so that nothing is enlarged");
  d.param("retain_shape", &BuildAppearance::retain_shape).within(0, 1).doc("share of the shape variance kept");
  d.param("retain_texture", &BuildAppearance::retain_texture).within(0, 1).doc("share of the texture variance kept");
  d.param("retain_combined", &BuildAppearance::retain_combined).within(0, 1).doc("share of the combined variance kept");
  d.param("levels", &BuildAppearance::levels)
      .within(1, 5)
      .doc("of the fitting pyramid, each half the size of the last");
}

}  // namespace talkgraph
