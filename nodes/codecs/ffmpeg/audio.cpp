#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "nodes/codecs/codecs.h"
#include "nodes/codecs/ffmpeg/decoder.h"

namespace talkgraph {
namespace {

template <class T>
void append_mean(const AVFrame& frame, bool planar, double zero, double full, std::vector<double>& out) {
  const int channels = frame.ch_layout.nb_channels;
  for (int i = 0; i < frame.nb_samples; ++i) {
    double sum = 0;
    for (int c = 0; c < channels; ++c) {
      const auto* row = reinterpret_cast<const T*>(frame.extended_data[planar ? c : 0]);
      sum += (static_cast<double>(row[planar ? i : i * channels + c]) - zero) / full;
    }
    out.push_back(sum / channels);
  }
}

/// Appends the mean of a frame's channels, full scale ±1.
void append(const AVFrame& frame, const std::string& path, std::vector<double>& out) {
  const auto format = static_cast<AVSampleFormat>(frame.format);
  const bool planar = av_sample_fmt_is_planar(format);
  switch (av_get_packed_sample_fmt(format)) {
    case AV_SAMPLE_FMT_U8:
      return append_mean<std::uint8_t>(frame, planar, 128, 128, out);
    case AV_SAMPLE_FMT_S16:
      return append_mean<std::int16_t>(frame, planar, 0, 0x1p15, out);
    case AV_SAMPLE_FMT_S32:
      return append_mean<std::int32_t>(frame, planar, 0, 0x1p31, out);
    case AV_SAMPLE_FMT_S64:
      return append_mean<std::int64_t>(frame, planar, 0, 0x1p63, out);
    case AV_SAMPLE_FMT_FLT:
      return append_mean<float>(frame, planar, 0, 1, out);
    case AV_SAMPLE_FMT_DBL:
      return append_mean<double>(frame, planar, 0, 1, out);
    default:
      throw std::runtime_error(path + ": its samples are of an unknown kind");
  }
}

/// When the first picture of the file is shown, seconds, or `otherwise`.
double picture_start(AVFormatContext& file, double otherwise) {
  const int best = av_find_best_stream(&file, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (best < 0) return otherwise;
  const AVStream& stream = *file.streams[best];
  if ((stream.disposition & AV_DISPOSITION_ATTACHED_PIC) || stream.start_time == AV_NOPTS_VALUE) return otherwise;
  return static_cast<double>(stream.start_time) * av_q2d(stream.time_base);
}

/// What is decoded of a sound track; times in seconds, NaN if the file does not say.
struct SoundTrack {
  std::vector<double> samples;
  int rate = 0;
  double start = 0, end = 0;
  double tick = 0;  ///< to which times are rounded
};

SoundTrack decode(Decoder& decoder, const std::string& path) {
  SoundTrack track;
  track.tick = av_q2d(decoder.stream().time_base);
  while (const AVFrame* frame = decoder.next()) {
    if (track.rate == 0) {
      track.rate = frame->sample_rate;
      track.start = decoder.time();
    }
    if (frame->sample_rate != track.rate || track.rate <= 0)
      throw std::runtime_error(path + ": the sample rate of its sound changes; convert it to WAV");
    if (decoder.damaged())
      throw std::runtime_error(fmt::format("{}: its sound is damaged at {:.2f} s; cut it there or copy it again", path,
                                           static_cast<double>(track.samples.size()) / track.rate));
    append(*frame, path, track.samples);
    track.end = decoder.time() + static_cast<double>(frame->pkt_duration) * track.tick;
  }
  if (track.samples.empty()) throw std::runtime_error(path + ": its sound track is empty");
  return track;
}

/// Takes off what the encoder added to fill its last block.
void cut_end(SoundTrack& track) {
  const double seconds = track.end - track.start;
  if (!(seconds > 0)) return;
  const auto too_many = std::ssize(track.samples) - std::llround(seconds * track.rate);
  if (static_cast<double>(too_many) > track.tick * track.rate)
    track.samples.resize(track.samples.size() - static_cast<std::size_t>(too_many));
}

/// Makes the sound start with the first picture. Less than 5 ms may be due to times
/// that the file holds rounded.
void align(SoundTrack& track, double picture, const std::string& path) {
  const double late = track.start - picture;
  if (!(std::abs(late) >= 0.005)) return;
  if (std::abs(late) > 60)
    throw std::runtime_error(fmt::format("{}: sound and picture start {:.0f} s apart", path, std::abs(late)));
  const auto shift = static_cast<std::ptrdiff_t>(std::llround(late * track.rate));
  if (shift > 0)
    track.samples.insert(track.samples.begin(), static_cast<std::size_t>(shift), 0.0);
  else
    track.samples.erase(track.samples.begin(), track.samples.begin() + std::min(-shift, std::ssize(track.samples)));
}

}  // namespace
}  // namespace talkgraph

void codec_ffmpeg_audio(const std::string& path, talkgraph::Audio& audio) {
  using namespace talkgraph;
  Decoder decoder(path, AVMEDIA_TYPE_AUDIO);
  SoundTrack track = decode(decoder, path);
  cut_end(track);
  align(track, picture_start(decoder.file(), track.start), path);
  audio.samples = Eigen::Map<const Eigen::VectorXd>(track.samples.data(), std::ssize(track.samples));
  audio.rate = track.rate;
}
