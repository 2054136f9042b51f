extern "C" {
#include <libavutil/opt.h>
}
#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>

#include "nodes/codecs/codecs.h"
#include "nodes/codecs/ffmpeg/handles.h"

namespace talkgraph {
namespace {

struct CloseOutput {
  void operator()(AVFormatContext* c) const {
    if (c->pb) avio_closep(&c->pb);
    avformat_free_context(c);
  }
};
using OutputHandle = std::unique_ptr<AVFormatContext, CloseOutput>;

/// Throws, naming the file, if an FFmpeg call failed.
class Check {
 public:
  explicit Check(std::string path) : path_(std::move(path)) {}
  void operator()(int code, const char* what) const {
    if (code < 0) throw std::runtime_error(fmt::format("{}: {}: {}", path_, what, ffmpeg_error(code)));
  }

 private:
  std::string path_;
};

/// One stream of the clip: its encoder and its place in the file.
class StreamWriter {
 public:
  StreamWriter(AVFormatContext& file, const char* encoder, const Check& check)
      : file_(file), check_(check), packet_(av_packet_alloc()) {
    const AVCodec* codec = avcodec_find_encoder_by_name(encoder);
    if (!codec) check_(AVERROR_ENCODER_NOT_FOUND, encoder);
    context_.reset(avcodec_alloc_context3(codec));
    context_->thread_count = 1;
    context_->flags |= AV_CODEC_FLAG_BITEXACT;
    if (file.oformat->flags & AVFMT_GLOBALHEADER) context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    stream_ = avformat_new_stream(&file, codec);
  }

  AVCodecContext& context() { return *context_; }
  AVStream& stream() { return *stream_; }
  /// Counts time from the encoder's first sample on, its priming included. Matroska
  /// wants it so: it takes the priming off again. With times below zero the muxer
  /// would delay the other streams.
  void count_priming() { offset_ = context_->initial_padding; }

  void open(AVDictionary* options) {
    const int opened = avcodec_open2(context_.get(), context_->codec, &options);
    av_dict_free(&options);
    check_(opened, "the encoder does not start");
    check_(avcodec_parameters_from_context(stream_->codecpar, context_.get()), "the encoder cannot be described");
    stream_->time_base = context_->time_base;
  }

  /// Encodes a frame, or ends the stream, and writes the packets that come out.
  /// `duration` in the encoder's time base serves where the encoder names none.
  void write(const AVFrame* frame, std::int64_t duration) {
    check_(avcodec_send_frame(context_.get(), frame), "a frame cannot be encoded");
    while (true) {
      const int got = avcodec_receive_packet(context_.get(), packet_.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      check_(got, "a frame cannot be encoded");
      if (packet_->duration == 0) packet_->duration = duration;
      packet_->pts += offset_;
      packet_->dts += offset_;
      av_packet_rescale_ts(packet_.get(), context_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check_(av_interleaved_write_frame(&file_, packet_.get()), "cannot be written: is there room on the disk?");
    }
  }

 private:
  AVFormatContext& file_;
  const Check& check_;
  PacketHandle packet_;
  CodecHandle context_;
  AVStream* stream_ = nullptr;
  std::int64_t offset_ = 0;
};

AVDictionary* options(std::initializer_list<std::pair<const char*, std::string>> entries) {
  AVDictionary* dictionary = nullptr;
  for (const auto& [key, value] : entries) av_dict_set(&dictionary, key, value.c_str(), 0);
  return dictionary;
}

class PictureWriter {
 public:
  PictureWriter(AVFormatContext& file, const Video& video, const ClipSettings& settings, const Check& check)
      : check_(check),
        size_(video.source->size()),
        out_(file, settings.format == ClipFormat::mp4 ? "libx264" : "libvpx-vp9", check) {
    const Rational rate = video.source->rate();
    AVCodecContext& c = out_.context();
    c.width = size_.width + size_.width % 2;
    c.height = size_.height + size_.height % 2;
    c.pix_fmt = AV_PIX_FMT_YUV420P;
    c.framerate = {static_cast<int>(rate.num()), static_cast<int>(rate.den())};
    c.time_base = av_inv_q(c.framerate);
    const bool hd = default_colours(c.height) == AVCOL_SPC_BT709;
    c.colorspace = hd ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M;
    c.color_primaries = hd ? AVCOL_PRI_BT709 : AVCOL_PRI_SMPTE170M;
    c.color_trc = hd ? AVCOL_TRC_BT709 : AVCOL_TRC_SMPTE170M;
    c.color_range = AVCOL_RANGE_MPEG;
    c.chroma_sample_location = AVCHROMA_LOC_LEFT;
    out_.stream().avg_frame_rate = out_.stream().r_frame_rate = c.framerate;
    const std::string crf = std::to_string(settings.crf);
    // Else x264's sums of reals depend on where its memory lies.
    const char* same_bits = "cpu-independent=1";
    out_.open(settings.format == ClipFormat::mp4
                  ? options({{"preset", "veryfast"}, {"crf", crf}, {"x264-params", same_bits}})
                  : options({{"crf", crf}, {"b", "0"}, {"deadline", "good"}, {"cpu-used", "4"}}));
    allocate(c);
  }

  void write(const cv::Mat& picture) {
    if (picture.size() != size_ || picture.type() != CV_8UC3)
      throw std::runtime_error(fmt::format("frame {} differs in size or kind from the others", count_));
    cv::Mat even = picture;
    if (size_.width % 2 || size_.height % 2)
      cv::copyMakeBorder(picture, even, 0, size_.height % 2, 0, size_.width % 2, cv::BORDER_REPLICATE);
    check_(av_frame_make_writable(frame_.get()), "no memory for a frame");
    const std::uint8_t* rows[] = {even.data};
    const int stride[] = {static_cast<int>(even.step)};
    sws_scale(scaler_.get(), rows, stride, 0, even.rows, frame_->data, frame_->linesize);
    frame_->pts = count_++;
    out_.write(frame_.get(), 1);
  }

  void finish() { out_.write(nullptr, 1); }
  std::int64_t count() const { return count_; }

 private:
  void allocate(const AVCodecContext& c) {
    frame_.reset(av_frame_alloc());
    frame_->format = c.pix_fmt;
    frame_->width = c.width;
    frame_->height = c.height;
    check_(av_frame_get_buffer(frame_.get(), 0), "no memory for a frame");
    scaler_.reset(sws_getContext(c.width, c.height, AV_PIX_FMT_BGR24, c.width, c.height, c.pix_fmt,
                                 SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr, nullptr));
    if (!scaler_) throw std::runtime_error("pictures of this size cannot be encoded");
    const int* table = sws_getCoefficients(c.colorspace);
    sws_setColorspaceDetails(scaler_.get(), table, 1, table, 0, 0, 1 << 16, 1 << 16);
  }

  const Check& check_;
  cv::Size size_;
  StreamWriter out_;
  FrameHandle frame_;
  ScalerHandle scaler_;
  std::int64_t count_ = 0;
};

class SoundWriter {
 public:
  SoundWriter(AVFormatContext& file, const Audio& audio, ClipFormat format, const Check& check)
      : check_(check), audio_(audio), out_(file, format == ClipFormat::mp4 ? "aac" : "libopus", check) {
    AVCodecContext& c = out_.context();
    c.sample_rate = static_cast<int>(audio.rate);
    c.sample_fmt = format == ClipFormat::mp4 ? AV_SAMPLE_FMT_FLTP : AV_SAMPLE_FMT_FLT;
    av_channel_layout_default(&c.ch_layout, 1);
    c.time_base = {1, c.sample_rate};
    c.bit_rate = format == ClipFormat::mp4 ? 96000 : 64000;
    out_.open(nullptr);
    if (format == ClipFormat::webm) out_.count_priming();
  }

  /// Encodes whole blocks up to a time, or all that is left.
  void write_until(double seconds) {
    const auto block = std::max<Eigen::Index>(1, out_.context().frame_size);
    while (at_ + block <= audio_.samples.size() && static_cast<double>(at_) < seconds * audio_.rate) write_block(block);
  }
  void finish() {
    write_until(audio_.seconds());
    if (at_ < audio_.samples.size()) write_block(audio_.samples.size() - at_);
    out_.write(nullptr, 0);
  }

 private:
  void write_block(Eigen::Index size) {
    const AVCodecContext& c = out_.context();
    const FrameHandle frame(av_frame_alloc());
    frame->format = c.sample_fmt;
    frame->nb_samples = static_cast<int>(size);
    frame->sample_rate = c.sample_rate;
    check_(av_channel_layout_copy(&frame->ch_layout, &c.ch_layout), "no memory for sound");
    check_(av_frame_get_buffer(frame.get(), 0), "no memory for sound");
    auto* samples = reinterpret_cast<float*>(frame->data[0]);
    for (Eigen::Index i = 0; i < size; ++i)
      samples[i] = static_cast<float>(std::clamp(audio_.samples[at_ + i], -1.0, 1.0));
    frame->pts = at_;
    at_ += size;
    out_.write(frame.get(), size);
  }

  const Check& check_;
  const Audio& audio_;
  StreamWriter out_;
  Eigen::Index at_ = 0;
};

OutputHandle open_output(const std::string& path, ClipFormat format, const Check& check) {
  AVFormatContext* file = nullptr;
  check(avformat_alloc_output_context2(&file, nullptr, format == ClipFormat::mp4 ? "mp4" : "webm",
                                       ("file:" + path).c_str()),
        "the format is not known");
  OutputHandle out(file);
  out->flags |= AVFMT_FLAG_BITEXACT;
  check(avio_open(&out->pb, ("file:" + path).c_str(), AVIO_FLAG_WRITE), "cannot be written");
  return out;
}

}  // namespace
}  // namespace talkgraph

void codec_ffmpeg_encode(const std::string& path, const talkgraph::Video& video, const talkgraph::Audio* audio,
                         const talkgraph::ClipSettings& settings, const talkgraph::Context& context) {
  using namespace talkgraph;
  av_log_set_level(AV_LOG_QUIET);
  const Check check(path);
  const OutputHandle file = open_output(path, settings.format, check);
  PictureWriter pictures(*file, video, settings, check);
  std::optional<SoundWriter> sound;
  if (audio) sound.emplace(*file, *audio, settings.format, check);

  AVDictionary* muxing = options({{"movflags", "+faststart"}, {"movie_timescale", "90000"}});
  const int started = avformat_write_header(file.get(), &muxing);
  av_dict_free(&muxing);
  check(started, "cannot be written");
  const auto reader = video.source->open();
  const auto frames = video.source->frames();
  for (cv::Mat picture; reader->next(picture);) {
    context.check_cancelled();
    pictures.write(picture);
    const auto done = static_cast<double>(pictures.count());
    if (sound) sound->write_until(done / video.source->rate().value());
    context.progress(done / static_cast<double>(frames));
  }
  if (pictures.count() != frames)
    throw std::runtime_error(
        fmt::format("{}: gave {} frames where {} were promised", video.source->name(), pictures.count(), frames));
  pictures.finish();
  if (sound) sound->finish();
  check(av_write_trailer(file.get()), "cannot be written to its end");
  check(avio_closep(&file->pb), "cannot be closed: is there room on the disk?");
}
