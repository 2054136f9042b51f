#include "nodes/types/appearance_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/types/stored_model.h"

namespace talkgraph {
namespace {

void shared_field(Archive& ar, std::string_view name, SharedMatrix& value) {
  Eigen::MatrixXf matrix;
  if (value) matrix = *value;
  ar(name, matrix);
  if (ar.loading()) value = std::make_shared<const Eigen::MatrixXf>(std::move(matrix));
}

/// A loaded model, whose file may be damaged: drawing and fitting rely on members that fit together.
class StoredFace {
 public:
  explicit StoredFace(const AppearanceModel& m) : m_(m) {}

  void check() const {
    const Eigen::Index n = m_.points(), k_s = m_.shape_variances.size(), k_g = m_.texture_variances.size();
    face_.require(n >= 3, "mean_shape", "has fewer than three points");
    face_.matrix("mean_shape", m_.mean_shape, n, 2);
    face_.require(m_.triangles.size() > 0 && m_.triangles.minCoeff() >= 0 && m_.triangles.maxCoeff() < n, "triangles",
                  "names points that are not there");
    face_.matrix("shape_modes", m_.shape_modes, 2 * n, k_s);
    face_.matrix("shape_variances", m_.shape_variances, k_s, 1);
    face_.matrix("texture_variances", m_.texture_variances, k_g, 1);
    face_.matrix("combined_modes", m_.combined_modes, k_s + k_g, m_.modes());
    face_.matrix("combined_variances", m_.combined_variances, m_.modes(), 1);
    face_.matrix("shape_per_mode", m_.shape_per_mode, 2 * n, m_.modes());
    face_.require(std::isfinite(m_.texture_offset), "texture_offset", "is not finite");
    face_.not_negative("residual", m_.residual);
    face_.positive("shape_weight", m_.shape_weight);
    face_.positive("texture_gain", m_.texture_gain);
    face_.positive("picture_scale", m_.picture_scale);
    face_.require(!m_.levels.empty(), "levels", "has none");
    for (std::size_t i = 0; i < m_.levels.size(); ++i) check(m_.levels[i], fmt::format("levels/{}/", i));
    texture("texture_modes", m_.texture_modes, 3 * m_.levels[0].raster.size(), k_g);
  }

 private:
  void check(const FitLevel& level, const std::string& name) const {
    const Raster& r = level.raster;
    const auto pixels = r.x.size();
    face_.require(pixels > 0, name + "raster/x", "has no pixel");
    face_.require(r.y.size() == pixels, name + "raster/y", "has not as many pixels as \"x\"");
    face_.require(r.triangle.size() == pixels, name + "raster/triangle", "has not as many pixels as \"x\"");
    within(name + "raster/x", r.x, r.width);
    within(name + "raster/y", r.y, r.height);
    within(name + "raster/triangle", r.triangle, m_.triangles.rows());
    face_.positive(name + "raster/scale", r.scale);
    face_.matrix(name + "raster/origin", r.origin, 2, 1);
    face_.matrix(name + "raster/points", r.points, m_.points(), 2);
    texture(name + "mean", level.mean, 3 * r.size(), 1);
    texture(name + "appearance", level.appearance, 3 * r.size(), m_.modes());
    texture(name + "change", level.change, 3 * r.size(), m_.shape_variances.size() + 4);
  }

  void within(const std::string& member, const std::vector<int>& values, Eigen::Index end) const {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    face_.require(*least >= 0 && *most < end, member, fmt::format("has values outside of 0 to {}", end - 1));
  }

  void texture(const std::string& member, const SharedMatrix& m, Eigen::Index rows, Eigen::Index columns) const {
    if (m->rows() != rows || m->cols() != columns)
      face_.require(false, member,
                    fmt::format("is {} × {} where the other members say {} × {}", m->rows(), m->cols(), rows, columns));
    face_.require(m->allFinite(), member, "has a value that is not finite");
  }

  const AppearanceModel& m_;
  const StoredModel face_{"face model"};
};

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
  if (ar.loading()) StoredFace(m).check();
}

}  // namespace talkgraph
