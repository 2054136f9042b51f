#include "nodes/speaker/talking_video.h"

#include <utility>

#include "graph/random.h"

namespace talkgraph::face {
namespace {

class TalkingVideo final : public VideoSource, public std::enable_shared_from_this<TalkingVideo> {
 public:
  TalkingVideo(std::shared_ptr<const Portrait> portrait, std::vector<Moment> moments, Rational rate, std::string name,
               const Key& key, std::uint64_t noise_seed)
      : portrait_(std::move(portrait)),
        moments_(std::move(moments)),
        rate_(rate),
        name_(std::move(name)),
        key_(key),
        noise_seed_(noise_seed) {}

  Rational rate() const override { return rate_; }
  std::int64_t frames() const override { return static_cast<std::int64_t>(moments_.size()); }
  cv::Size size() const override { return picture_size(portrait_->height()); }
  std::string name() const override { return name_; }
  Key key() const override { return key_; }
  std::unique_ptr<VideoSource::Reader> open() const override;

 private:
  class Reader final : public VideoSource::Reader {
   public:
    explicit Reader(std::shared_ptr<const TalkingVideo> video)
        : video_(std::move(video)), noise_(video_->noise_seed_) {}
    bool next(cv::Mat& frame) override {
      if (at_ == video_->moments_.size()) return false;
      frame = video_->draw(at_++, noise_.bits());
      return true;
    }

   private:
    std::shared_ptr<const TalkingVideo> video_;
    Random noise_;
    std::size_t at_ = 0;
  };

  cv::Mat draw(std::size_t t, std::uint64_t grain) const {
    return portrait_->drawn().frame(key_, t, [&] { return portrait_->renderer().draw(moments_[t], grain); });
  }

  std::shared_ptr<const Portrait> portrait_;
  std::vector<Moment> moments_;
  Rational rate_;
  std::string name_;
  Key key_;
  std::uint64_t noise_seed_;
};

std::unique_ptr<VideoSource::Reader> TalkingVideo::open() const { return std::make_unique<Reader>(shared_from_this()); }

}  // namespace

const Renderer& Portrait::renderer() const {
  std::call_once(painted_, [this] { renderer_.emplace(height_, seed_); });
  return *renderer_;
}

Video talking_video(std::shared_ptr<const Portrait> portrait, std::vector<Moment> moments, Rational rate,
                    std::string name, const Key& key, std::uint64_t noise_seed) {
  Video video;
  video.source = std::make_shared<const TalkingVideo>(std::move(portrait), std::move(moments), rate, std::move(name),
                                                      key, noise_seed);
  return video;
}

}  // namespace talkgraph::face
