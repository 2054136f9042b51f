#include "nodes/evaluate/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/types/paired.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

std::vector<cv::Point> hull(const Shape& shape, const std::vector<int>& points) {
  std::vector<cv::Point> all, corners;
  for (const int i : points) {
    if (i < 0 || i >= shape.rows())
      throw std::runtime_error(fmt::format("landmarks of {} points have no point {}", shape.rows(), i));
    all.emplace_back(static_cast<int>(std::lround(shape(i, 0))), static_cast<int>(std::lround(shape(i, 1))));
  }
  if (!all.empty()) cv::convexHull(all, corners);
  return corners;
}

cv::Mat inside(const std::vector<cv::Point>& corners, cv::Size size) {
  cv::Mat mask(size, CV_8U, cv::Scalar(0));
  if (!corners.empty()) cv::fillConvexPoly(mask, corners, 255);
  return mask;
}

cv::Mat grey(const cv::Mat& frame) {
  cv::Mat out;
  cv::cvtColor(frame, out, cv::COLOR_BGR2GRAY);
  out.convertTo(out, CV_32F);
  return out;
}

cv::Mat similarity(const cv::Mat& a, const cv::Mat& b) {
  const auto blur = [](const cv::Mat& m) {
    cv::Mat out;
    cv::GaussianBlur(m, out, {11, 11}, 1.5);
    return out;
  };
  const double c1 = std::pow(0.01 * 255, 2), c2 = std::pow(0.03 * 255, 2);
  const cv::Mat ma = blur(a), mb = blur(b), maa = ma.mul(ma), mbb = mb.mul(mb), mab = ma.mul(mb);
  const cv::Mat aa = blur(a.mul(a)) - maa, bb = blur(b.mul(b)) - mbb, ab = blur(a.mul(b)) - mab;
  cv::Mat out;
  cv::divide((2 * mab + c1).mul(2 * ab + c2), (maa + mbb + c1).mul(aa + bb + c2), out);
  return out;
}

/// Squared length of the gradient, central differences.
cv::Mat gradient_energy(const cv::Mat& a) {
  cv::Mat dx, dy;
  cv::Sobel(a, dx, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(a, dy, CV_32F, 0, 1, 1, 0.5);
  return dx.mul(dx) + dy.mul(dy);
}

/// Sum of squared steps across an outline, from a pixel and a half inside it to as much outside.
double steps_across(const cv::Mat& a, const std::vector<cv::Point>& corners) {
  const cv::Rect whole({}, a.size());
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point2d from = corners[i], along = cv::Point2d(corners[(i + 1) % corners.size()]) - from;
    const double length = cv::norm(along);
    const cv::Point2d normal = cv::Point2d(along.y, -along.x) * (1.5 / length);
    for (double s = 0; s < length; ++s) {
      const cv::Point2d at = from + along * (s / length);
      const cv::Point p = at + normal, q = at - normal;
      if (whole.contains(p) && whole.contains(q)) sum += std::pow(a.at<float>(p) - a.at<float>(q), 2);
    }
  }
  return sum;
}

/// Of values under masks, all pixels and channels alike.
class Mean {
 public:
  void add(const cv::Mat& values, const cv::Mat& mask) {
    const cv::Scalar mean = cv::mean(values, mask);
    const double pixels = cv::countNonZero(mask);
    for (int channel = 0; channel < values.channels(); ++channel) sum_ += pixels * mean[channel];
    count_ += pixels * values.channels();
  }
  double value() const { return count_ > 0 ? sum_ / count_ : NAN; }

 private:
  double sum_ = 0, count_ = 0;
};

/// Of a mean squared error, at most 100; NaN where there is none.
double decibels(double error) { return std::isnan(error) ? NAN : std::min(100.0, 10 * std::log10(255 * 255 / error)); }

double ratio(double drawn, double recorded) { return recorded > 0 ? drawn / recorded : NAN; }

cv::Mat squared_difference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat d;
  cv::subtract(a, b, d, cv::noArray(), CV_32F);
  return d.mul(d);
}

/// Two pictures of one frame, BGR.
struct Frame {
  cv::Mat recorded, drawn;
};

/// The part of a picture that the measures of a face look at: similarity reaches 5 pixels beyond it.
cv::Rect around(const std::vector<cv::Point>& outline, cv::Size picture) {
  constexpr int reach = 6;
  const cv::Rect face = cv::boundingRect(outline);
  return cv::Rect(face.tl() - cv::Point(reach, reach), face.br() + cv::Point(reach, reach)) & cv::Rect({}, picture);
}

class Comparison {
 public:
  explicit Comparison(const ComparePictures& settings) : settings_(settings) {}

  /// Whether any of the face is in the picture; otherwise nothing counts.
  bool add(const Frame& now, const Frame* before, const Shape& shape) {
    std::vector<int> all(static_cast<std::size_t>(shape.rows()));
    std::iota(all.begin(), all.end(), 0);
    const cv::Rect box = around(hull(shape, all), now.recorded.size());
    if (box.empty()) return false;
    const Shape here = shape.rowwise() - Eigen::RowVector2d(box.x, box.y);
    const auto outline = hull(here, all);
    const cv::Mat face = inside(outline, box.size()), mouth = inside(hull(here, settings_.mouth), box.size());
    const cv::Mat error = squared_difference(now.recorded(box), now.drawn(box));
    error_face_.add(error, face);
    error_mouth_.add(error, mouth);
    if (before) {
      recorded_.change.add(squared_difference(now.recorded(box), before->recorded(box)), mouth);
      drawn_.change.add(squared_difference(now.drawn(box), before->drawn(box)), mouth);
    }
    const cv::Mat recorded = grey(now.recorded(box)), drawn = grey(now.drawn(box));
    const cv::Mat alike = similarity(recorded, drawn);
    alike_face_.add(alike, face);
    alike_mouth_.add(alike, mouth);
    add_sharpness(recorded, drawn, hull(here, settings_.inner));
    recorded_.steps += steps_across(recorded, outline);
    drawn_.steps += steps_across(drawn, outline);
    return true;
  }

  Scores scores() const {
    Scores s;
    s.values["psnr_face"] = decibels(error_face_.value());
    s.values["psnr_mouth"] = decibels(error_mouth_.value());
    s.values["ssim_face"] = alike_face_.value();
    s.values["ssim_mouth"] = alike_mouth_.value();
    s.values["sharpness"] = ratio(drawn_.gradient.value(), recorded_.gradient.value());
    s.values["jumps"] = std::sqrt(ratio(drawn_.change.value(), recorded_.change.value()));
    s.values["seam"] = std::sqrt(ratio(drawn_.steps, recorded_.steps));
    return s;
  }

 private:
  void add_sharpness(const cv::Mat& recorded, const cv::Mat& drawn, const std::vector<cv::Point>& lips) {
    const cv::Rect box = cv::boundingRect(lips);
    if (box.height < settings_.parted * box.width) return;
    const cv::Mat mask = inside(lips, recorded.size());
    recorded_.gradient.add(gradient_energy(recorded), mask);
    drawn_.gradient.add(gradient_energy(drawn), mask);
  }

  struct Side {
    Mean gradient, change;
    double steps = 0;
  };
  const ComparePictures& settings_;
  Mean error_face_, error_mouth_, alike_face_, alike_mouth_;
  Side recorded_, drawn_;
};

}  // namespace

std::optional<Scores> ComparePictures::operator()(const Video& recorded, const Video& drawn,
                                                  const LandmarkTrack& landmarks) const {
  if (recorded.source->size() != drawn.source->size())
    throw std::runtime_error(recorded.source->name() + " and " + drawn.source->name() + " differ in size");
  const auto frames = recorded.source->frames();
  common_frames(recorded.source->name(), frames, "frames recorded", drawn.source->frames(), "drawn");
  common_frames(recorded.source->name(), frames, "frames recorded", std::ssize(landmarks.frames), "with landmarks");
  const auto with_points =
      std::find_if(landmarks.frames.begin(), landmarks.frames.end(), [](const Shape& s) { return s.rows() > 0; });
  if (with_points == landmarks.frames.end()) return {};
  ComparePictures settings = *this;
  const auto part = [&](const char* name) { return scheme_of(landmarks.scheme, with_points->rows()).named(name); };
  if (mouth.empty()) settings.mouth = part("outer_lips");
  if (inner.empty()) settings.inner = part("inner_lips");
  Comparison comparison(settings);
  const auto left = recorded.source->open(), right = drawn.source->open();
  Frame now, before;
  bool counts = false;
  std::size_t compared = 0, seen = 0;
  for (std::size_t t = 0; t < landmarks.frames.size(); ++t) {
    now = {};
    if (!left->next(now.recorded) || !right->next(now.drawn)) break;
    ++seen;
    const bool counted = counts;
    const Shape& shape = landmarks.frames[t];
    counts = !recorded.is_damaged(static_cast<std::int64_t>(t)) && shape.rows() > 0 && shape.allFinite() &&
             comparison.add(now, counted ? &before : nullptr, shape);
    if (!counts) continue;
    before = now;
    ++compared;
  }
  if (compared == 0) return {};
  Scores scores = comparison.scores();
  scores.values["left_out"] = static_cast<double>(seen - compared);
  return scores;
}

void describe(Description<ComparePictures>& d) {
  d.type("evaluate.pictures")
      .version(4)
      .summary("how near a drawn face comes to the recorded one: likeness, sharpness, jumps, seam");
  d.source("SSIM: Wang, Bovik, Sheikh & Simoncelli 2004").stored();
  d.input("recorded", "the clip")
      .input("drawn", "the same with a face drawn on it")
      .input("landmarks", "of the recorded face; frames without do not count")
      .output("scores",
              "psnr_face: peak signal to noise ratio of the drawn face, dB; psnr_mouth: peak signal to noise ratio of "
              "the drawn mouth, dB; ssim_face: structural similarity of the drawn face, 1 at best; ssim_mouth: "
              "structural similarity of the drawn mouth, 1 at best; sharpness: gradient of the grey levels between "
              "parted lips, drawn / recorded; jumps: change of the mouth from frame to frame, drawn / recorded; seam: "
              "step across the face's edge, drawn / recorded; left_out: frames that do not count");
  d.param("mouth", &ComparePictures::mouth)
      .at_least(0)
      .doc("landmarks around the lips; empty: outer lips of the point scheme");
  d.param("inner", &ComparePictures::inner)
      .at_least(0)
      .doc("landmarks between the lips; empty: inner lips of the point scheme");
  d.param("parted", &ComparePictures::parted)
      .within(0, 1)
      .doc("least height between the lips, as a share of the width there, of frames whose sharpness counts");
}

}  // namespace talkgraph
