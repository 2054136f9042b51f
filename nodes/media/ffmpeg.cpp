#include "nodes/media/ffmpeg.h"

#include <stdexcept>

#include "nodes/codecs/codecs.h"
#include "nodes/types/codec.h"

namespace talkgraph {
namespace {

void check_built_with_ffmpeg(const std::string& path) {
  if (!built_with_ffmpeg)
    throw std::runtime_error(path +
                             ": talkgraph was built without FFmpeg (TALKGRAPH_FFMPEG=OFF): it reads WAV, FLAC and OGG "
                             "sound and folders of pictures, and neither reads nor writes videos");
}

}  // namespace

const bool built_with_ffmpeg = TALKGRAPH_FFMPEG;

std::shared_ptr<const VideoSource> ffmpeg_video(const std::string& path) {
  check_built_with_ffmpeg(path);
  std::shared_ptr<const VideoSource> video;
  codec<decltype(codec_ffmpeg_video)>("codec_ffmpeg_video")(path, video);
  return video;
}

Audio ffmpeg_audio(const std::string& path) {
  check_built_with_ffmpeg(path);
  Audio audio;
  codec<decltype(codec_ffmpeg_audio)>("codec_ffmpeg_audio")(path, audio);
  return audio;
}

void ffmpeg_encode(const std::string& path, const Video& video, const Audio* audio, const ClipSettings& settings,
                   const Context& context) {
  check_built_with_ffmpeg(path);
  codec<decltype(codec_ffmpeg_encode)>("codec_ffmpeg_encode")(path, video, audio, settings, context);
}

}  // namespace talkgraph
