#include "nodes/codecs/ffmpeg/decoder.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <string_view>

namespace talkgraph {
namespace {

/// FFmpeg's own log is switched off once: what matters is thrown.
void silence_log() {
  static const bool once = [] { return av_log_set_level(AV_LOG_QUIET), true; }();
  (void)once;
}

/// Demuxers that take any text for a picture.
bool is_text(const AVInputFormat& format) { return std::string_view(format.name) == "tty"; }

}  // namespace

Decoder::Decoder(const std::string& path, AVMediaType kind)
    : path_(path), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
  silence_log();
  open_file(kind);
}

void Decoder::open_file(AVMediaType kind) {
  AVFormatContext* file = nullptr;
  // The prefix keeps names such as "concat:" and "http:" what they are: file names.
  const int opened = avformat_open_input(&file, ("file:" + path_).c_str(), nullptr, nullptr);
  if (opened < 0)
    throw std::runtime_error(fmt::format("{}: cannot be read as video or sound: {}", path_, ffmpeg_error(opened)));
  file_.reset(file);
  if (is_text(*file->iformat) || avformat_find_stream_info(file, nullptr) < 0)
    throw std::runtime_error(path_ + ": is neither a video nor sound");

  const AVCodec* codec = nullptr;
  const int best = av_find_best_stream(file, kind, -1, -1, &codec, 0);
  if (best < 0 || (file->streams[best]->disposition & AV_DISPOSITION_ATTACHED_PIC))
    throw std::runtime_error(
        fmt::format("{}: holds no {} that can be decoded", path_, kind == AVMEDIA_TYPE_VIDEO ? "video" : "sound"));
  stream_ = file->streams[best];
  for (unsigned i = 0; i < file->nb_streams; ++i)
    if (static_cast<int>(i) != best) file->streams[i]->discard = AVDISCARD_ALL;
  open_codec(codec);
}

void Decoder::open_codec(const AVCodec* codec) {
  codec_.reset(avcodec_alloc_context3(codec));
  avcodec_parameters_to_context(codec_.get(), stream_->codecpar);
  codec_->thread_count = 1;
  codec_->pkt_timebase = stream_->time_base;
  codec_->flags |= AV_CODEC_FLAG_OUTPUT_CORRUPT | AV_CODEC_FLAG_BITEXACT;
  const int opened = avcodec_open2(codec_.get(), codec, nullptr);
  if (opened < 0)
    throw std::runtime_error(fmt::format("{}: {} cannot be decoded: {}", path_, codec->name, ffmpeg_error(opened)));
}

const AVFrame* Decoder::next() {
  while (true) {
    const int got = avcodec_receive_frame(codec_.get(), frame_.get());
    if (got == AVERROR_EOF) return nullptr;
    if (got == AVERROR(EAGAIN)) {
      feed();
    } else if (got < 0) {
      broken_packet_ = true;
    } else {
      damaged_ = broken_packet_ || frame_->decode_error_flags || (frame_->flags & AV_FRAME_FLAG_CORRUPT);
      broken_packet_ = false;
      return frame_.get();
    }
  }
}

void Decoder::feed() {
  int got = 0;
  do {
    av_packet_unref(packet_.get());
    got = av_read_frame(file_.get(), packet_.get());
  } while (got >= 0 && packet_->stream_index != stream_->index);
  if (got < 0 && got != AVERROR_EOF)
    throw std::runtime_error(fmt::format("{}: breaks off or is damaged: {}; copy it again", path_, ffmpeg_error(got)));
  if (packet_->flags & AV_PKT_FLAG_CORRUPT) broken_packet_ = true;
  const int sent = avcodec_send_packet(codec_.get(), got == AVERROR_EOF ? nullptr : packet_.get());
  if (sent < 0 && sent != AVERROR_EOF) broken_packet_ = true;
}

bool Decoder::damaged() const { return damaged_; }

double Decoder::time() const {
  if (frame_->best_effort_timestamp == AV_NOPTS_VALUE) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(frame_->best_effort_timestamp) * av_q2d(stream_->time_base);
}

}  // namespace talkgraph
