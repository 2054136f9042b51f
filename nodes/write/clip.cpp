#include "nodes/write/clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/media/audio_file.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/types/item_file.h"

namespace talkgraph {
namespace {

bool takes_rate(ClipFormat format, double rate) {
  constexpr std::array aac = {8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000, 64000, 88200, 96000};
  // Opus counts in 48 kHz whatever it is given, and the muxer mistakes its delay at other rates.
  if (format == ClipFormat::webm) return rate == 48000;
  return std::find(aac.begin(), aac.end(), rate) != aac.end();
}

/// The sound at a rate that the format takes, padded or cut to `seconds`.
Audio fitted(const Audio& audio, double seconds, ClipFormat format) {
  Audio out = takes_rate(format, audio.rate) ? audio : resampled(audio, 48000);
  const auto wanted = std::llround(seconds * out.rate);
  const auto kept = std::min<Eigen::Index>(wanted, out.samples.size());
  out.samples.conservativeResize(wanted);
  out.samples.tail(wanted - kept).setZero();
  return out;
}

}  // namespace

Artifact WriteClip::operator()(const Video& video, const Audio* audio, Context& context) const {
  const auto frames = video.source ? video.source->frames() : 0;
  if (frames == 0) throw std::runtime_error("a clip without one frame cannot be encoded");
  const double seconds = static_cast<double>(frames) / video.source->rate().value();
  std::optional<Audio> sound;
  if (audio) sound = fitted(*audio, seconds, format);
  const char* const ending = format == ClipFormat::mp4 ? ".mp4" : ".webm";
  const Artifact artifact = item_file(context, folder, ending, "clip", prefix, suffix);
  OutputFile file(context.file(artifact.path));
  ffmpeg_encode(file.part(), video, sound ? &*sound : nullptr, {format, crf}, context);
  file.finish();
  return artifact;
}

void describe(Description<WriteClip>& d) {
  d.type("write.clip").summary("writes a clip as MP4 or WebM: pictures, and sound of the same length").sink();
  d.input("video", "the pictures")
      .input("audio", "padded with silence or cut to the length of the picture")
      .output("file", "the clip");
  d.param("folder", &WriteClip::folder).doc("below the run folder");
  d.param("prefix", &WriteClip::prefix).doc("in front of the item's name");
  d.param("suffix", &WriteClip::suffix).doc("behind the item's name");
  d.param("format", &WriteClip::format).doc("mp4: H.264 and AAC; webm: VP9 and Opus");
  d.param("crf", &WriteClip::crf).within(0, 51).doc("constant rate factor: lower is better and larger");
}

}  // namespace talkgraph
