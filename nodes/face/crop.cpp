#include "nodes/face/crop.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

void extend(Eigen::AlignedBox2d& box, const Eigen::RowVector2d& point) {
  if (point.allFinite()) box.extend(point.transpose());
}

Eigen::AlignedBox2d box_of(const LandmarkTrack& landmarks, const std::vector<int>& points) {
  Eigen::AlignedBox2d box;
  for (const Shape& shape : landmarks.frames) {
    if (points.empty())
      for (const auto& point : shape.rowwise()) extend(box, point);
    for (const int point : points) {
      if (point >= shape.rows())
        throw std::runtime_error(fmt::format("landmarks of {} points have no point {}", shape.rows(), point));
      extend(box, shape.row(point));
    }
  }
  if (box.isEmpty()) throw std::runtime_error("there are no landmarks to crop a video to");
  return box;
}

/// First pixel and even number of pixels of a side from `low` to `high`, in a picture of `size`.
std::pair<int, int> side(double low, double high, int size) {
  const int first = std::max(0, static_cast<int>(std::floor(low)));
  const int last = std::min(size - 1, static_cast<int>(std::ceil(high)));
  int length = (last - first + 2) & ~1;
  if (first + length > size) length -= 2;
  if (length < 2) throw std::runtime_error("the landmarks lie outside the picture");
  return {first, length};
}

class CropReader final : public VideoSource::Reader {
 public:
  CropReader(const Video& video, cv::Rect part) : reader_(video.source->open()), part_(part) {}
  bool next(cv::Mat& frame) override {
    cv::Mat whole;
    if (!reader_->next(whole)) return false;
    frame = whole(part_).clone();
    return true;
  }

 private:
  std::unique_ptr<VideoSource::Reader> reader_;
  cv::Rect part_;
};

class CropSource final : public VideoSource {
 public:
  CropSource(Video video, cv::Rect part) : video_(std::move(video)), part_(part) {}
  Rational rate() const override { return video_.source->rate(); }
  std::int64_t frames() const override { return video_.source->frames(); }
  cv::Size size() const override { return part_.size(); }
  std::unique_ptr<Reader> open() const override { return std::make_unique<CropReader>(video_, part_); }
  std::string name() const override { return video_.source->name(); }
  std::vector<std::int64_t> decoding_errors() const override { return video_.source->decoding_errors(); }
  Key key() const override {
    return content_key([&](Archive& ar) {
      auto video = video_.source->key();
      auto part = part_;
      ar("video", video);
      ar("x", part.x);
      ar("y", part.y);
      ar("width", part.width);
      ar("height", part.height);
    });
  }

 private:
  Video video_;
  cv::Rect part_;
};

}  // namespace

Video Crop::operator()(const Video& video, const LandmarkTrack& landmarks) const try {
  auto taken = points;
  for (const auto& name : names)
    for (const int point : scheme_of(landmarks).named(name)) taken.push_back(point);
  auto box = box_of(landmarks, taken);
  const Eigen::Vector2d wider = Eigen::Vector2d::Constant(margin * box.sizes().maxCoeff());
  box = {box.min() - wider, box.max() + wider};
  const cv::Size size = video.source->size();
  const auto [left, width] = side(box.min().x(), box.max().x(), size.width);
  const auto [top, height] = side(box.min().y(), box.max().y(), size.height);
  return {std::make_shared<CropSource>(video, cv::Rect(left, top, width, height)), video.damaged};
} catch (const std::runtime_error& e) {
  throw std::runtime_error(video.source->name() + ": " + e.what());
}

void describe(Description<Crop>& d) {
  d.type("face.crop").summary("cuts out of a video what holds some landmarks, such as the mouth");
  d.input("video", "what is cut")
      .input("landmarks", "points of every frame, in its pictures")
      .output("video", "the cut, which follows nothing: one place in all frames");
  d.param("points", &Crop::points).at_least(0).doc("numbers of points; without points and names: all");
  d.param("names", &Crop::names).doc("names of groups (\"outer_lips\") or points (\"mouth_left\") of the scheme");
  d.param("margin", &Crop::margin).within(0, 10).doc("added on each side, share of the longer side of their box");
}

}  // namespace talkgraph
