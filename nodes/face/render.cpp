#include "nodes/face/render.h"

#include <cmath>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>

#include "nodes/face/draw.h"
#include "nodes/face/eyes.h"
#include "nodes/face/look.h"

namespace talkgraph {
namespace {

/// What the pictures of a model's faces show.
struct View {
  double zoom;
  Eigen::RowVector2d middle;  ///< model frame
  cv::Size size;
  int hidden = 0;  ///< rows at the top

  /// Even sides, with room for the face to move by a tenth of its size.
  View(const AppearanceModel& model, const RenderFace& settings) : zoom(settings.zoom) {
    Eigen::RowVector2d low = model.mean_shape.colwise().minCoeff();
    const Eigen::RowVector2d high = model.mean_shape.colwise().maxCoeff();
    if (settings.part == FacePart::lower) low.y() = below_eyes(model);
    const Eigen::RowVector2d extent = 1.2 * (high - low);
    middle = 0.5 * (low + high);
    if (settings.size > 0) zoom = settings.size / extent.maxCoeff();
    const auto side = [&](double length) { return 2 * static_cast<int>(std::ceil(0.5 * (length * zoom + 2))); };
    size = settings.size > 0 ? cv::Size(settings.size, settings.size) : cv::Size(side(extent.x()), side(extent.y()));
    if (settings.part == FacePart::lower) hidden = static_cast<int>(std::ceil(place(low).y()));
  }

  Eigen::RowVector2d place(const Eigen::RowVector2d& at) const {
    return zoom * (at - middle) + Eigen::RowVector2d(0.5 * (size.width - 1), 0.5 * (size.height - 1));
  }
};

/// Draws faces of one model, one after the other.
class Brush {
 public:
  Brush(const AppearanceModel& model, const RenderFace& settings)
      : model_(model), background_(settings.background), view_(model, settings) {
    const auto& raster = model.levels.at(0).raster;
    picture_ = cv::Mat(raster.height, raster.width, CV_8UC4, cv::Scalar::all(background_));
  }

  cv::Mat operator()(const Look& look) {
    const auto& raster = model_.levels[0].raster;
    lay_out(look.texture);
    Shape to = look.shape;
    for (auto point : to.rowwise()) point = view_.place(point);
    cv::Mat out(view_.size, CV_8UC3, cv::Scalar::all(background_));
    draw_triangles(out, to, picture_, raster.points, model_.triangles);
    out.rowRange(0, view_.hidden).setTo(cv::Scalar::all(background_));
    return out;
  }

 private:
  /// The texture in grey levels, as a picture.
  void lay_out(const Eigen::VectorXf& texture) {
    const auto& raster = model_.levels[0].raster;
    const auto gain = cv::v_setall_f32(static_cast<float>(model_.texture_gain)),
               offset = cv::v_setall_f32(static_cast<float>(model_.texture_offset));
    auto* const pixels = picture_.data;
    const auto step = static_cast<std::ptrdiff_t>(picture_.step);
    const auto put = [&](std::size_t i, const float* value) {
      const auto grey = cv::v_round(cv::v_load(value) * gain + offset);
      const auto narrow = cv::v_pack(grey, grey);
      const unsigned pixel = cv::v_reinterpret_as_u32(cv::v_pack_u(narrow, narrow)).get0();
      std::memcpy(pixels + raster.y[i] * step + 4 * raster.x[i], &pixel, 4);
    };
    const std::size_t last = raster.x.size() - 1;
    for (std::size_t i = 0; i < last; ++i) put(i, texture.data() + 3 * i);
    const float end[4] = {texture(texture.size() - 3), texture(texture.size() - 2), texture(texture.size() - 1), 0};
    put(last, end);
  }

  const AppearanceModel& model_;
  int background_;
  View view_;
  cv::Mat picture_;
};

struct Scene {
  std::shared_ptr<const Looks> looks;
  RenderFace settings;
};

class FaceReader final : public VideoSource::Reader {
 public:
  explicit FaceReader(const Scene& scene)
      : looks_(scene.looks), reader_(scene.looks), brush_(looks_->model(), scene.settings) {}
  bool next(cv::Mat& frame) override {
    const Look* look = reader_.next();
    if (look) frame = brush_(*look);
    return look;
  }

 private:
  std::shared_ptr<const Looks> looks_;
  LookReader reader_;
  Brush brush_;
};

class FaceSource final : public VideoSource {
 public:
  explicit FaceSource(Scene scene) : scene_(std::move(scene)) {}
  Rational rate() const override { return scene_.looks->parameters().rate; }
  std::int64_t frames() const override { return scene_.looks->parameters().frames(); }
  cv::Size size() const override { return View(scene_.looks->model(), scene_.settings).size; }
  std::unique_ptr<Reader> open() const override { return std::make_unique<FaceReader>(scene_); }
  std::string name() const override { return "rendered face"; }
  Key key() const override {
    return content_key([&](Archive& ar) {
      auto settings = scene_.settings;
      scene_.looks->hash(ar);
      ar("zoom", settings.zoom);
      ar("background", settings.background);
      auto part = static_cast<std::int64_t>(settings.part);
      ar("part", part);
      ar("size", settings.size);
    });
  }

 private:
  Scene scene_;
};

}  // namespace

cv::Mat draw_face(const AppearanceModel& model, const Eigen::VectorXd& c, double zoom, int background) {
  return Brush(model, {zoom, background})({model.shape(c), model.texture(c)});
}

Video RenderFace::operator()(const AppearanceModel& model, const Track& parameters, const Eyes* eyes,
                             const MouthTrack* mouths) const {
  auto looks = std::make_shared<Looks>(model, parameters, eyes, mouths);
  if (part == FacePart::lower) below_eyes(model);  // throws now, not when read
  return {std::make_shared<FaceSource>(Scene{std::move(looks), *this}), {}};
}

void describe(Description<RenderFace>& d) {
  d.type("face.render").version(3).summary("the face of appearance parameters alone, on a plain background");
  d.source("Thesis Eqn 3.18, §6.3.5; docs/method.md §2");
  d.input("model", "of the face")
      .input("parameters", "appearance parameters c")
      .input("eyes", "shown in place of the parameters' own")
      .input("mouths", "real ones, shown in place of the model's")
      .output("video", "as many frames as the track has");
  d.param("zoom", &RenderFace::zoom).positive().doc("pixels per pixel of the mean shape, where no size is given");
  d.param("background", &RenderFace::background).within(0, 255).doc("grey level around the face");
  d.param("part", &RenderFace::part).doc("the whole face, or what lies below the eyes");
  d.param("size", &RenderFace::size)
      .within(0, 4096)
      .unit("pixels")
      .doc("of square pictures, which the part fills; 0: pictures as large as the face needs at this zoom");
}

}  // namespace talkgraph
