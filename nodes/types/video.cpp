#include "nodes/types/video.h"

#include <algorithm>
#include <stdexcept>

#include "nodes/codecs/codecs.h"
#include "nodes/types/codec.h"

namespace talkgraph {
namespace {

class MemoryVideo final : public VideoSource {
 public:
  MemoryVideo(std::vector<cv::Mat> frames, Rational rate, std::string name)
      : frames_(std::move(frames)), rate_(rate), name_(std::move(name)) {}

  Rational rate() const override { return rate_; }
  std::int64_t frames() const override { return static_cast<std::int64_t>(frames_.size()); }
  cv::Size size() const override { return frames_.empty() ? cv::Size() : frames_.front().size(); }
  std::string name() const override { return name_; }
  Key key() const override {
    KeyMaker maker;
    maker.add(rate_.str());
    for (const auto& frame : frames_)
      for (int y = 0; y < frame.rows; ++y)
        maker.add({frame.ptr<char>(y), static_cast<std::size_t>(frame.cols) * frame.elemSize()});
    return maker.key();
  }
  std::unique_ptr<Reader> open() const override { return std::make_unique<MemoryReader>(frames_); }

 private:
  class MemoryReader final : public Reader {
   public:
    explicit MemoryReader(const std::vector<cv::Mat>& frames) : frames_(frames) {}
    bool next(cv::Mat& frame) override {
      if (at_ == frames_.size()) return false;
      frame = frames_[at_++].clone();
      return true;
    }

   private:
    const std::vector<cv::Mat> frames_;
    std::size_t at_ = 0;
  };

  std::vector<cv::Mat> frames_;
  Rational rate_;
  std::string name_;
};

std::vector<std::uint8_t> to_png(const cv::Mat& pixels) {
  std::vector<std::uint8_t> png;
  if (!pixels.empty()) codec<decltype(codec_encode_png)>("codec_encode_png")(pixels, png);
  return png;
}

cv::Mat from_png(const std::vector<std::uint8_t>& png) {
  if (png.empty()) return {};
  cv::Mat pixels;
  codec<decltype(codec_decode_picture)>("codec_decode_picture")(png, pixels);
  if (pixels.empty()) throw std::runtime_error("a stored picture cannot be decoded");
  return pixels;
}

}  // namespace

bool Video::is_damaged(std::int64_t frame) const {
  return std::find(damaged.begin(), damaged.end(), frame) != damaged.end();
}

std::vector<cv::Mat> Video::read_all() const {
  std::vector<cv::Mat> all;
  const auto reader = source->open();
  for (cv::Mat frame; reader->next(frame); frame = cv::Mat()) all.push_back(frame);
  return all;
}

Video video_from_frames(std::vector<cv::Mat> frames, Rational rate, std::string name) {
  return {std::make_shared<MemoryVideo>(std::move(frames), rate, std::move(name)), {}};
}

void fields(Archive& ar, Video& v) {
  if (ar.hashing()) {
    Key key = v.source ? v.source->key() : Key();
    ar("source", key);
    ar("damaged", v.damaged);
    return;
  }
  Rational rate = v.source ? v.source->rate() : Rational(25);
  std::string name = v.source ? v.source->name() : "";
  ar("rate", rate, "Hz");
  ar("name", name);
  ar("damaged", v.damaged);
  const auto reader = !ar.loading() && v.source ? v.source->open() : nullptr;
  auto size = reader ? static_cast<std::size_t>(v.source->frames()) : 0;
  std::vector<cv::Mat> frames;
  ar.list("frames", size, [&](std::size_t i) {
    Image image;
    if (reader && !reader->next(image.pixels))
      throw std::runtime_error(name + ": ends before its last frame, " + std::to_string(size - 1));
    ar(std::to_string(i), image);
    if (ar.loading()) frames.push_back(image.pixels);
  });
  ar.note("frames", "rate_hz", rate.value());
  if (!ar.loading()) return;
  auto damaged = std::move(v.damaged);
  v = video_from_frames(std::move(frames), rate, name);
  v.damaged = std::move(damaged);
}

void fields(Archive& ar, Image& i) {
  auto png = to_png(i.pixels);
  ar("png", png);
  if (ar.loading()) i.pixels = from_png(png);
}

}  // namespace talkgraph
