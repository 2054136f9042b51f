#include "nodes/face/redraw.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/face/draw.h"
#include "nodes/face/shapes.h"

namespace talkgraph {
namespace {

struct Scene {
  AppearanceModel model;
  FaceTrack track;
  Video video;
};

void draw(const Scene& scene, std::size_t t, cv::Mat& frame) {
  const Eigen::VectorXd c = scene.track.parameters.values.row(static_cast<Eigen::Index>(t));
  const Eigen::VectorXf texture = (scene.model.texture(c) * static_cast<float>(scene.track.gain[t])).array() +
                                  static_cast<float>(scene.track.offset[t]);
  draw_texture(scene.model, texture, scene.track.shapes[t], frame);
}

class RedrawnReader final : public VideoSource::Reader {
 public:
  explicit RedrawnReader(std::shared_ptr<const Scene> scene)
      : scene_(std::move(scene)), reader_(scene_->video.source->open()) {}
  bool next(cv::Mat& frame) override {
    cv::Mat recorded;
    if (at_ == scene_->track.shapes.size() || !reader_->next(recorded)) return false;
    frame = recorded.clone();
    draw(*scene_, at_++, frame);
    return true;
  }

 private:
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<VideoSource::Reader> reader_;
  std::size_t at_ = 0;
};

class RedrawnSource final : public VideoSource {
 public:
  explicit RedrawnSource(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)) {}
  Rational rate() const override { return scene_->video.source->rate(); }
  std::int64_t frames() const override { return scene_->video.source->frames(); }
  cv::Size size() const override { return scene_->video.source->size(); }
  std::unique_ptr<Reader> open() const override { return std::make_unique<RedrawnReader>(scene_); }
  std::string name() const override { return scene_->video.source->name() + " redrawn"; }
  Key key() const override {
    return content_key([&](Archive& ar) {
      auto scene = *scene_;
      ar("model", scene.model);
      ar("track", scene.track);
      ar("video", scene.video);
    });
  }

 private:
  std::shared_ptr<const Scene> scene_;
};

}  // namespace

Video RedrawFace::operator()(const AppearanceModel& model, const FaceTrack& track, const Video& video) const {
  check_dimension(model, track.parameters);
  if (video.source->frames() != static_cast<std::int64_t>(track.shapes.size()))
    throw std::runtime_error(fmt::format("{} has {} frames, its face track has {}", video.source->name(),
                                         video.source->frames(), track.shapes.size()));
  return {std::make_shared<RedrawnSource>(std::make_shared<Scene>(Scene{model, track, video})), video.damaged};
}

void describe(Description<RedrawFace>& d) {
  d.type("face.redraw")
      .version(2)
      .summary("what the face model sees in a clip: its face drawn where it was found")
      .source("Thesis Eqn 3.18; docs/method.md §2");
  d.input("model", "of the face")
      .input("track", "of the clip")
      .input("video", "the clip")
      .output("video", "as many frames as the clip has");
}

}  // namespace talkgraph
