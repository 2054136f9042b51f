extern "C" {
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
}
#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "graph/key.h"
#include "nodes/codecs/codecs.h"
#include "nodes/codecs/ffmpeg/decoder.h"

namespace talkgraph {
namespace {

/// What decoding the whole file once tells.
struct Scan {
  std::vector<std::int64_t> shown;    ///< decoded picture of each frame: ascending
  std::vector<std::int64_t> damaged;  ///< frames whose picture the decoder complained about
};

/// Which picture each frame of a constant rate shows: picture n at frame n where
/// the times are regular, else the last one that has appeared by the frame's centre.
std::vector<std::int64_t> constant_rate(const std::vector<double>& times, double rate, const std::string& path) {
  const auto pictures = static_cast<std::int64_t>(times.size());
  bool known = true, regular = true;
  for (std::int64_t n = 0; n < pictures; ++n) {
    known = known && std::isfinite(times[n]);
    regular = regular && std::abs((times[n] - times[0]) * rate - static_cast<double>(n)) < 0.75;
  }
  auto frames = pictures;
  if (known && !regular) frames = std::llround((times.back() - times[0]) * rate) + 1;
  if (frames < 1 || frames > 20 * pictures + 100)
    throw std::runtime_error(path + ": the times of its pictures jump; convert it to a constant frame rate");
  std::vector<std::int64_t> shown(static_cast<std::size_t>(frames));
  std::int64_t picture = 0;
  for (std::int64_t k = 0; k < frames; ++k) {
    const auto appeared = [&](std::int64_t n) { return (times[n] - times[0]) * rate <= static_cast<double>(k) + 0.5; };
    if (!known || regular)
      picture = k;
    else
      while (picture + 1 < pictures && appeared(picture + 1)) ++picture;
    shown[k] = picture;
  }
  return shown;
}

/// Compares what the container promises with what was there.
void check_length(const AVStream& stream, double seconds, const std::string& path) {
  if (stream.duration == AV_NOPTS_VALUE) return;
  const double promised = static_cast<double>(stream.duration) * av_q2d(stream.time_base);
  if (seconds < promised - std::max(0.5, 0.02 * promised))
    throw std::runtime_error(fmt::format("{}: breaks off: its header promises {:.2f} s of video, {:.2f} s are there",
                                         path, promised, seconds));
}

Scan scan(const std::string& path, Rational rate) {
  Decoder decoder(path, AVMEDIA_TYPE_VIDEO);
  std::vector<double> times;
  std::vector<bool> damaged;
  while (decoder.next()) {
    times.push_back(decoder.time());
    damaged.push_back(decoder.damaged());
  }
  if (times.empty()) throw std::runtime_error(path + ": breaks off or is damaged: not one picture can be decoded");
  Scan result{constant_rate(times, rate.value(), path), {}};
  const auto frames = static_cast<std::int64_t>(result.shown.size());
  check_length(decoder.stream(), static_cast<double>(frames) / rate.value(), path);
  for (std::int64_t k = 0; k < frames; ++k)
    if (damaged[result.shown[k]]) result.damaged.push_back(k);
  return result;
}

/// Quarter turns clockwise that show the picture upright.
int quarter_turns(AVStream& stream) {
  const auto* matrix =
      reinterpret_cast<const std::int32_t*>(av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (!matrix) return 0;
  const double degrees = av_display_rotation_get(matrix);  // counter-clockwise
  return std::isfinite(degrees) ? static_cast<int>(std::lround(-degrees / 90) % 4 + 4) % 4 : 0;
}

bool is_full_range(const AVFrame& frame) {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  return frame.color_range == AVCOL_RANGE_JPEG || format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P ||
         format == AV_PIX_FMT_YUVJ444P || format == AV_PIX_FMT_YUVJ440P;
}

/// Decoded pictures to 8-bit BGR of one size.
class ToBgr {
 public:
  ToBgr(cv::Size size, int turns) : size_(size), turns_(turns) {}

  cv::Mat operator()(const AVFrame& frame) {
    constexpr int flags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT;
    scaler_.reset(sws_getCachedContext(scaler_.release(), frame.width, frame.height,
                                       static_cast<AVPixelFormat>(frame.format), size_.width, size_.height,
                                       AV_PIX_FMT_BGR24, flags, nullptr, nullptr, nullptr));
    if (!scaler_) throw std::runtime_error("its pixels cannot be converted to colours");
    const auto colours = frame.colorspace == AVCOL_SPC_UNSPECIFIED ? default_colours(frame.height) : frame.colorspace;
    const int* table = sws_getCoefficients(colours);
    sws_setColorspaceDetails(scaler_.get(), table, is_full_range(frame), table, 1, 0, 1 << 16, 1 << 16);
    // The scaler may write a little beyond the end of a row.
    cv::Mat wide(size_.height, (size_.width + 63) / 64 * 64, CV_8UC3);
    std::uint8_t* rows[] = {wide.data};
    const int stride[] = {static_cast<int>(wide.step)};
    sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, rows, stride);
    const cv::Mat picture = wide.colRange(0, size_.width);
    if (turns_ == 0) return picture.clone();
    cv::Mat turned;
    cv::rotate(picture, turned, turns_ - 1);  // ROTATE_90_CLOCKWISE, ROTATE_180, ROTATE_90_COUNTERCLOCKWISE
    return turned;
  }

 private:
  cv::Size size_;
  int turns_;
  ScalerHandle scaler_;
};

class FileVideo final : public VideoSource {
 public:
  explicit FileVideo(const std::string& path) : path_(path) {
    Decoder decoder(path, AVMEDIA_TYPE_VIDEO);
    const AVRational rate = av_guess_frame_rate(&decoder.file(), &decoder.stream(), nullptr);
    if (rate.num <= 0 || rate.den <= 0) throw std::runtime_error(path + ": does not say its frame rate");
    rate_ = Rational(rate.num, rate.den);
    coded_ = {decoder.stream().codecpar->width, decoder.stream().codecpar->height};
    if (coded_.empty()) throw std::runtime_error(path + ": does not say the size of its pictures");
    turns_ = quarter_turns(decoder.stream());
  }

  Rational rate() const override { return rate_; }
  std::int64_t frames() const override { return static_cast<std::int64_t>(scanned().shown.size()); }
  cv::Size size() const override { return turns_ % 2 ? cv::Size(coded_.height, coded_.width) : coded_; }
  std::string name() const override { return path_; }
  Key key() const override { return file_key(path_); }
  std::vector<std::int64_t> decoding_errors() const override { return scanned().damaged; }
  std::unique_ptr<Reader> open() const override { return std::make_unique<FileReader>(*this); }

 private:
  class FileReader final : public Reader {
   public:
    explicit FileReader(const FileVideo& video)
        : path_(video.path_),
          shown_(video.scanned().shown),
          decoder_(video.path_, AVMEDIA_TYPE_VIDEO),
          convert_(video.coded_, video.turns_) {}

    bool next(cv::Mat& frame) override {
      if (at_ == shown_.size()) return false;
      const AVFrame* decoded = nullptr;
      for (; picture_ < shown_[at_]; ++picture_) decoded = decode();
      if (decoded) last_ = convert_(*decoded);
      frame = last_.clone();
      ++at_;
      return true;
    }

   private:
    const AVFrame* decode() {
      const AVFrame* decoded = decoder_.next();
      if (!decoded) throw std::runtime_error(path_ + ": has become shorter while it was read");
      return decoded;
    }

    std::string path_;
    std::vector<std::int64_t> shown_;
    Decoder decoder_;
    ToBgr convert_;
    cv::Mat last_;
    std::int64_t picture_ = -1;  ///< the one in last_
    std::size_t at_ = 0;
  };

  const Scan& scanned() const {
    std::call_once(once_, [this] { scan_ = scan(path_, rate_); });
    return scan_;
  }

  std::string path_;
  Rational rate_;
  cv::Size coded_;
  int turns_ = 0;
  mutable std::once_flag once_;
  mutable Scan scan_;
};

}  // namespace
}  // namespace talkgraph

void codec_ffmpeg_video(const std::string& path, std::shared_ptr<const talkgraph::VideoSource>& video) {
  video = std::make_shared<talkgraph::FileVideo>(path);
}
