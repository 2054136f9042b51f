#include "nodes/face/render.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/face/draw.h"
#include "nodes/face/geometry.h"
#include "nodes/face/sampling.h"
#include "nodes/face/shapes.h"

namespace talkgraph {
namespace {

/// Even, with room for the face to move by a tenth of its size.
cv::Size canvas(const AppearanceModel& model, double zoom) {
  const Eigen::RowVector2d extent = model.mean_shape.colwise().maxCoeff() - model.mean_shape.colwise().minCoeff();
  const auto side = [&](double length) { return 2 * static_cast<int>(std::ceil(0.5 * (1.2 * length * zoom + 2))); };
  return {side(extent.x()), side(extent.y())};
}

struct Scene {
  AppearanceModel model;
  Track parameters;
  RenderFace settings;
};

class FaceReader final : public VideoSource::Reader {
 public:
  explicit FaceReader(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)) {}
  bool next(cv::Mat& frame) override {
    if (at_ == scene_->parameters.frames()) return false;
    frame = draw_face(scene_->model, scene_->parameters.values.row(at_++), scene_->settings.zoom,
                      scene_->settings.background);
    return true;
  }

 private:
  std::shared_ptr<const Scene> scene_;
  Eigen::Index at_ = 0;
};

class FaceSource final : public VideoSource {
 public:
  explicit FaceSource(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)) {}
  Rational rate() const override { return scene_->parameters.rate; }
  std::int64_t frames() const override { return scene_->parameters.frames(); }
  cv::Size size() const override { return canvas(scene_->model, scene_->settings.zoom); }
  std::unique_ptr<Reader> open() const override { return std::make_unique<FaceReader>(scene_); }
  std::string name() const override { return "rendered face"; }
  Key key() const override {
    return content_key([&](Archive& ar) {
      auto scene = *scene_;
      ar("model", scene.model);
      ar("parameters", scene.parameters);
      ar("zoom", scene.settings.zoom);
      ar("background", scene.settings.background);
    });
  }

 private:
  std::shared_ptr<const Scene> scene_;
};

}  // namespace

cv::Mat draw_face(const AppearanceModel& model, const Eigen::VectorXd& c, double zoom, int background) {
  const auto size = canvas(model, zoom);
  const auto& raster = model.levels.at(0).raster;
  const Eigen::RowVector2d middle =
      0.5 * (model.mean_shape.colwise().maxCoeff() + model.mean_shape.colwise().minCoeff());
  const Shape to = ((model.shape(c).rowwise() - middle) * zoom).rowwise() +
                   Eigen::RowVector2d(0.5 * (size.width - 1), 0.5 * (size.height - 1));
  const Eigen::VectorXf texture =
      (model.texture(c) * static_cast<float>(model.texture_gain)).array() + static_cast<float>(model.texture_offset);
  cv::Mat picture = raster_picture(raster, texture, cv::Scalar::all(background)), map = empty_map(size), out;
  draw_map(map, to, raster.points, model.triangles);
  cv::remap(picture, out, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(background));
  out.convertTo(out, CV_8UC3);
  return out;
}

Video RenderFace::operator()(const AppearanceModel& model, const Track& parameters) const {
  check_dimension(model, parameters);
  return {std::make_shared<FaceSource>(std::make_shared<Scene>(Scene{model, parameters, *this})), {}};
}

void describe(Description<RenderFace>& d) {
  d.type("face.render").version(1).summary("the face of appearance parameters alone, on a plain background");
  d.source("Thesis Eqn 3.18; docs/method.md §2");
  d.input("model", "of the face")
      .input("parameters", "appearance parameters c")
      .output("video", "as many frames as the track has");
  d.param("zoom", &RenderFace::zoom).positive().doc("pixels per pixel of the mean shape");
  d.param("background", &RenderFace::background).within(0, 255).doc("grey level around the face");
}

}  // namespace talkgraph
