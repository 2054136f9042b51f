#include "nodes/media/ffmpeg.h"

#include <stdexcept>

namespace talkgraph {
namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw std::runtime_error(path +
                           ": talkgraph was built without FFmpeg (TALKGRAPH_FFMPEG=OFF): it reads WAV, FLAC and OGG "
                           "sound and folders of pictures, and neither reads nor writes videos");
}

}  // namespace

const bool built_with_ffmpeg = false;

std::shared_ptr<const VideoSource> ffmpeg_video(const std::string& path) { refuse(path); }
Audio ffmpeg_audio(const std::string& path) { refuse(path); }
void ffmpeg_encode(const std::string& path, const Video&, const Audio*, const ClipSettings&, const Context&) {
  refuse(path);
}

}  // namespace talkgraph
