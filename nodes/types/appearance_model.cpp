#include "nodes/types/appearance_model.h"

namespace talkgraph {
namespace {

void shared_field(Archive& ar, std::string_view name, SharedMatrix& value) {
  Eigen::MatrixXf matrix;
  if (value) matrix = *value;
  ar(name, matrix);
  if (ar.loading()) value = std::make_shared<const Eigen::MatrixXf>(std::move(matrix));
}

}  // namespace

Shape AppearanceModel::shape(const Eigen::VectorXd& c) const {
  const Eigen::VectorXd moved = shape_per_mode * c;
  return mean_shape +
         Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(moved.data(), points(), 2);
}

Eigen::VectorXf AppearanceModel::texture(const Eigen::VectorXd& c, std::size_t level) const {
  const auto& at = levels.at(level);
  const Eigen::VectorXf c_float = c.cast<float>();
  Eigen::VectorXf texture = at.mean->col(0);
  texture.noalias() += *at.appearance * c_float;
  return texture;
}

void fields(Archive& ar, Raster& r) {
  ar("width", r.width);
  ar("height", r.height);
  ar("scale", r.scale);
  ar("origin", r.origin);
  ar("points", r.points);
  ar("x", r.x);
  ar("y", r.y);
  ar("triangle", r.triangle);
}

void fields(Archive& ar, FitLevel& f) {
  ar("raster", f.raster);
  shared_field(ar, "mean", f.mean);
  shared_field(ar, "appearance", f.appearance);
  shared_field(ar, "change", f.change);
}

void fields(Archive& ar, AppearanceModel& m) {
  ar("scheme", m.scheme);
  ar("mean_shape", m.mean_shape, "pixel");
  ar("triangles", m.triangles);
  ar("shape_modes", m.shape_modes);
  ar("shape_variances", m.shape_variances);
  shared_field(ar, "texture_modes", m.texture_modes);
  ar("texture_variances", m.texture_variances);
  ar("shape_weight", m.shape_weight);
  ar("combined_modes", m.combined_modes);
  ar("combined_variances", m.combined_variances);
  ar("shape_per_mode", m.shape_per_mode);
  ar("texture_offset", m.texture_offset);
  ar("texture_gain", m.texture_gain);
  ar("residual", m.residual);
  ar("picture_scale", m.picture_scale);
  ar("levels", m.levels);
}

}  // namespace talkgraph
