#include "nodes/face/composite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "nodes/face/base_clip.h"
#include "nodes/face/draw.h"
#include "nodes/face/geometry.h"
#include "nodes/face/look.h"
#include "nodes/face/membrane.h"
#include "nodes/face/sampling.h"
#include "nodes/face/shapes.h"

namespace talkgraph {
namespace {

constexpr int ring_points = 24;
constexpr double ring_size = 1.45;  ///< of the half extent: where the bent surroundings end

/// The mean shape and a ring around it that stays in place.
Shape with_ring(const Shape& shape, const Shape& ring) {
  Shape all(shape.rows() + ring.rows(), 2);
  all << shape, ring;
  return all;
}

Shape ring_around(const Shape& shape) {
  const Eigen::RowVector2d low = shape.colwise().minCoeff(), high = shape.colwise().maxCoeff();
  Shape ring(ring_points, 2);
  for (int i = 0; i < ring_points; ++i) {
    const double angle = 2 * std::numbers::pi * i / ring_points;
    // A superellipse: it clears the corners of a square jaw.
    const auto root = [](double v) { return std::copysign(std::sqrt(std::abs(v)), v); };
    ring.row(i) =
        0.5 * (low + high) +
        0.5 * ring_size * (high - low).cwiseProduct(Eigen::RowVector2d(root(std::cos(angle)), root(std::sin(angle))));
  }
  return ring;
}

/// Everything about a model and its blending that does not change from frame to frame.
class Painter {
 public:
  Painter(const CompositeFace& settings, const Looks& looks)
      : whole_(settings.part == FacePart::whole),
        looks_(looks),
        model_(looks.model()),
        raster_(model_.levels[0].raster) {
    ring_ = ring_around(model_.mean_shape);
    mesh_ = delaunay(with_ring(model_.mean_shape, ring_));
    const double top = raster_.points.col(1).minCoeff(), height = raster_.points.col(1).maxCoeff() - top;
    const auto share_below = [&](double y) {
      return whole_ ? 1.0 : smooth_step(settings.blend_from, settings.blend_to, (y - top) / height);
    };
    moves_.resize(model_.points());
    for (Eigen::Index i = 0; i < moves_.size(); ++i) moves_(i) = share_below(raster_.points(i, 1));
    make_masks(share_below, settings);
  }

  cv::Mat paint(const cv::Mat& frame, const FaceTrack& track, std::size_t t, const Look& look) const {
    const Eigen::VectorXd own = track.parameters.values.row(static_cast<Eigen::Index>(t));
    const Pose& pose = track.poses[t];
    const Shape before = model_.shape(own), after = moved(before, look.shape);
    cv::Mat painted = frame.clone();
    const cv::Rect part = around(transform(pose, ring_), frame.size());
    if (part.empty()) return painted;
    const Pose here{pose.scale, pose.angle, pose.dx - part.x, pose.dy - part.y};
    const Shape ring = transform(here, ring_), from = transform(here, before), to = transform(here, after);

    cv::Mat map = identity_map(part.size()), bent;
    draw_map(map, with_ring(to, ring), with_ring(from, ring), mesh_);
    cv::remap(frame(part), bent, map, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    bent.convertTo(bent, CV_32FC3);

    const cv::Rect face = around(to, part.size());
    cv::Mat face_map = empty_map(face.size());
    draw_map(face_map, to.rowwise() - Eigen::RowVector2d(face.x, face.y), raster_.points, model_.triangles);
    blend(bent(face), face_map, track.gain[t], track.offset[t], model_.texture(own), look.texture);
    bent.convertTo(painted(part), CV_8UC3);
    return painted;
  }

 private:
  /// What of a picture the points enclose.
  static cv::Rect around(const Shape& points, cv::Size size) {
    const Eigen::RowVector2d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
    const auto within = [](double v, int n) { return static_cast<int>(std::clamp(v, -1.0, n + 1.0)); };
    const cv::Point from(within(low.x() - 2, size.width), within(low.y() - 2, size.height)),
        to(within(high.x() + 3, size.width), within(high.y() + 3, size.height));
    return cv::Rect(from, to) & cv::Rect({}, size);
  }

  template <class Share>
  void make_masks(const Share& share_below, const CompositeFace& settings) {
    const double feather = settings.feather * (raster_.width - 3);
    cv::Mat inside(raster_.height, raster_.width, CV_8U, cv::Scalar(0)), distance, changed = inside.clone();
    for (std::size_t i = 0; i < raster_.x.size(); ++i) inside.at<unsigned char>(raster_.y[i], raster_.x[i]) = 255;
    cv::distanceTransform(inside, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    const cv::Mat replaced = cv::max(replaced_share(), looks_.mouth_share());
    keep_ = cv::Mat(inside.size(), CV_32F, cv::Scalar(0));
    replace_ = keep_.clone();
    for (std::size_t i = 0; i < raster_.x.size(); ++i) {
      const cv::Point at(raster_.x[i], raster_.y[i]);
      const float below = std::max(static_cast<float>(share_below(at.y)), looks_.eye_share().at<float>(at));
      changed.at<unsigned char>(at) = below > 0;
      const float mask = settings.seam == Seam::poisson
                             ? static_cast<float>(below > 0)
                             : below * static_cast<float>(smooth_step(0, feather, distance.at<float>(at) - 0.5));
      replace_.at<float>(at) = mask * replaced.at<float>(at);
      keep_.at<float>(at) = mask - replace_.at<float>(at);
    }
    if (settings.seam == Seam::poisson) membrane_.emplace(changed);
  }

  /// 1 where the texture varies far more than over the rest of the face (the
  /// inner mouth, the eyes): there the base's own detail does not belong.
  cv::Mat replaced_share() const {
    Eigen::VectorXf variance =
        model_.levels[0].appearance->array().square().matrix() * model_.combined_variances.cast<float>();
    Eigen::VectorXf deviation(variance.size());
    for (Eigen::Index i = 0; i < variance.size(); i += 3)
      deviation.segment<3>(i).setConstant(std::sqrt(variance.segment<3>(i).mean()));
    cv::Mat picture = raster_picture(raster_, deviation);
    cv::GaussianBlur(picture, picture, {}, 0.01 * raster_.width);
    std::vector<float> sorted;
    for (std::size_t i = 0; i < raster_.x.size(); ++i) sorted.push_back(deviation(static_cast<Eigen::Index>(3 * i)));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    cv::Mat share(picture.size(), CV_32F, cv::Scalar(0));
    for (int y = 0; y < share.rows; ++y)
      for (int x = 0; x < share.cols; ++x)
        share.at<float>(y, x) =
            static_cast<float>(smooth_step(1.5 * usual, 3.5 * usual, picture.at<cv::Vec3f>(y, x)[0]));
    return share;
  }

  /// The base's shape with the synthesised one in the moving part, both model
  /// frame. The parts that stay are laid upon each other first: an opening jaw
  /// shifts the Procrustes frame.
  Shape moved(const Shape& before, const Shape& wanted) const {
    if (whole_) return wanted;
    const Eigen::VectorXd stays = (1 - moves_.array()).max(1e-6);
    const Shape change = transform(align(wanted, before, stays), wanted) - before;
    return with_points(before + moves_.asDiagonal() * change, wanted, looks_.eye_points());
  }

  void blend(cv::Mat face, const cv::Mat& map, double gain, double offset, const Eigen::VectorXf& own,
             const Eigen::VectorXf& wanted) const {
    if (face.empty()) return;
    const auto g = static_cast<float>(gain);
    const Eigen::VectorXf change = g * (wanted - own);
    const Eigen::VectorXf colour = (g * wanted).array() + static_cast<float>(offset);
    cv::Mat added = raster_picture(raster_, change), painted = raster_picture(raster_, colour, cv::Scalar::all(offset));
    if (membrane_) {
      const cv::Mat step = (*membrane_)(added);
      added -= step;
      painted -= step;
    }
    const cv::Mat keep = on_face(keep_, map, cv::INTER_LINEAR), replace = on_face(replace_, map, cv::INTER_LINEAR);
    const cv::Rect replaced = cv::boundingRect(replace > 0);
    added = on_face(added, map, cv::INTER_LINEAR);
    painted = on_face(painted, map(replaced), cv::INTER_CUBIC);
    for (int y = 0; y < face.rows; ++y)
      for (int x = 0; x < face.cols; ++x) {
        auto& pixel = face.at<cv::Vec3f>(y, x);
        const float k = keep.at<float>(y, x), r = replace.at<float>(y, x);
        const auto step = k > 0 ? k * added.at<cv::Vec3f>(y, x) : cv::Vec3f();
        if (r > 0) pixel += r * (painted.at<cv::Vec3f>(y - replaced.y, x - replaced.x) - pixel);
        pixel += step;
      }
  }

  /// A picture of the raster where the map shows it.
  static cv::Mat on_face(const cv::Mat& picture, const cv::Mat& map, int interpolation) {
    cv::Mat out;
    if (!map.empty()) cv::remap(picture, out, map, cv::noArray(), interpolation, cv::BORDER_CONSTANT);
    return out;
  }

  bool whole_;
  const Looks& looks_;
  const AppearanceModel& model_;
  const Raster& raster_;
  Shape ring_;
  Triangles mesh_;
  Eigen::VectorXd moves_;             ///< per landmark: 1 follows the parameters, 0 stays
  cv::Mat keep_, replace_;            ///< raster: shares of adding to, and of replacing, the base picture
  std::optional<Membrane> membrane_;  ///< over what is changed
};

/// 0, 1 ... n-1, n-2 ... 1, 0, 1 ...
std::int64_t back_and_forth(std::int64_t i, std::int64_t n) {
  if (n == 1) return 0;
  const auto at = i % (2 * n - 2);
  return at < n ? at : 2 * n - 2 - at;
}

struct Plan {
  Plan(const CompositeFace& settings, std::shared_ptr<const Looks> shown)
      : looks(std::move(shown)), painter(settings, *looks) {}
  std::shared_ptr<const Looks> looks;
  Painter painter;
  BaseClip base;
  GoodRun run;
  bool loops = false;  ///< the run is too short, so it goes back and forth
  std::string settings;

  const Track& parameters() const { return looks->parameters(); }
  std::int64_t base_frame(std::int64_t t) const {
    const double seconds = (static_cast<double>(t) + 0.5) / parameters().rate.value();
    const auto i = static_cast<std::int64_t>(seconds * base.frames.source->rate().value());
    return run.first + back_and_forth(i, run.length);
  }
};

class CompositeReader final : public VideoSource::Reader {
 public:
  explicit CompositeReader(std::shared_ptr<const Plan> plan)
      : plan_(std::move(plan)), looks_(plan_->looks), base_(plan_->base.frames.source->open()) {}

  bool next(cv::Mat& frame) override {
    const Look* look = looks_.next();
    if (!look) return false;
    const auto t = plan_->base_frame(at_++);
    frame = plan_->painter.paint(picture(t), plan_->base.track, static_cast<std::size_t>(t), *look);
    return true;
  }

 private:
  const cv::Mat& picture(std::int64_t t) {
    while (read_ <= t) {
      if (!base_->next(frame_))
        throw std::runtime_error(plan_->base.frames.source->name() + " ends before frame " + std::to_string(t));
      if (plan_->loops && read_ >= plan_->run.first) run_.push_back(frame_.clone());
      ++read_;
    }
    return plan_->loops ? run_[static_cast<std::size_t>(t - plan_->run.first)] : frame_;
  }

  std::shared_ptr<const Plan> plan_;
  LookReader looks_;
  std::unique_ptr<VideoSource::Reader> base_;
  cv::Mat frame_;             // the last one read
  std::vector<cv::Mat> run_;  // kept where the base runs backwards later on
  std::int64_t read_ = 0, at_ = 0;
};

class CompositeSource final : public VideoSource {
 public:
  explicit CompositeSource(std::shared_ptr<const Plan> plan) : plan_(std::move(plan)) {}
  Rational rate() const override { return plan_->parameters().rate; }
  std::int64_t frames() const override { return plan_->parameters().frames(); }
  cv::Size size() const override { return plan_->base.frames.source->size(); }
  std::unique_ptr<Reader> open() const override { return std::make_unique<CompositeReader>(plan_); }
  std::string name() const override { return "face drawn on " + plan_->base.frames.source->name(); }
  Key key() const override {
    return content_key([&](Archive& ar) {
      auto track = plan_->base.track;
      auto base = plan_->base.frames.source->key();
      auto settings = plan_->settings;
      plan_->looks->hash(ar);
      ar("track", track);
      ar("base", base);
      ar("settings", settings);
    });
  }

 private:
  std::shared_ptr<const Plan> plan_;
};

/// A run that must go back and forth is kept in memory, so it is not a long one.
void limit_run(Plan& plan) {
  constexpr double longest = 10;  // seconds
  const double base_rate = plan.base.frames.source->rate().value();
  const double needed = static_cast<double>(plan.parameters().frames()) / plan.parameters().rate.value() * base_rate;
  plan.loops = needed > static_cast<double>(plan.run.length) + 1e-6;  // equal rates are not quite equal when divided
  if (plan.loops)
    plan.run.length = std::min(plan.run.length, static_cast<std::int64_t>(std::ceil(longest * base_rate)));
}

}  // namespace

Video CompositeFace::operator()(const AppearanceModel& model, const Track& parameters, const BaseClip& base,
                                const Eyes* eyes, const MouthTrack* mouths) const {
  check_dimension(model, base.track.parameters);
  if (blend_from > blend_to) throw std::invalid_argument("blend_from must not exceed blend_to");
  auto plan = std::make_shared<Plan>(*this, std::make_shared<Looks>(model, parameters, eyes, mouths));
  plan->base = base;
  plan->run = longest_good_run(base.track);
  plan->settings =
      fmt::format("{} {} {} {} {}", static_cast<int>(part), blend_from, blend_to, static_cast<int>(seam), feather);
  limit_run(*plan);
  if (plan->run.length == 0)
    throw std::runtime_error(
        base.frames.source->name() +
        ": the model finds its face in no frame: it must be the speaker learnt, in colour, of about the size "
        "in the recordings");
  return {std::make_shared<CompositeSource>(std::move(plan)), {}};
}

void describe(Description<CompositeFace>& d) {
  d.type("face.composite").version(6).summary("draws a synthesised face on the frames of a real clip");
  d.source("Thesis §3.1.3, §6.3.5; docs/method.md §2");
  d.input("model", "of the face")
      .input("parameters", "appearance parameters c")
      .input("base", "what is drawn upon; it runs forwards and backwards where it is too short")
      .input("eyes", "shown in place of the base's")
      .input("mouths", "real ones, shown in place of the model's")
      .output("video", "as many frames as the parameters have");
  d.param("part", &CompositeFace::part)
      .doc("what the parameters rule: the lower face, or all of it with eyes and brows");
  d.param("blend_from", &CompositeFace::blend_from)
      .within(0, 1)
      .doc("share of the face's height above which the base stays");
  d.param("blend_to", &CompositeFace::blend_to)
      .within(0, 1)
      .doc("share of the face's height below which the parameters rule");
  d.param("seam", &CompositeFace::seam)
      .doc("how the face joins the picture: its change fades out, or keeps its gradients");
  d.param("feather", &CompositeFace::feather)
      .within(0, 0.5)
      .doc("width of the fading at the face's edge, share of its width");
}

}  // namespace talkgraph
