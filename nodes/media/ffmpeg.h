#pragma once

#include <memory>
#include <string>

#include "graph/context.h"
#include "nodes/media/clip.h"
#include "nodes/types/audio.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// What FFmpeg's libraries do here. In a build without them (CMake option
/// TALKGRAPH_FFMPEG=OFF) `built_with_ffmpeg` is false and each function throws
/// std::runtime_error that says so.
extern const bool built_with_ffmpeg;

std::shared_ptr<const VideoSource> ffmpeg_video(const std::string& path);

/// The sound track, aligned to the first picture where the file has pictures.
Audio ffmpeg_audio(const std::string& path);

/// Writes all frames of a video, and sound of the same length and of a rate that
/// the format takes. A side of odd length is extended by one row or column.
void ffmpeg_encode(const std::string& path, const Video& video, const Audio* audio, const ClipSettings& settings,
                   const Context& context);

}  // namespace talkgraph
