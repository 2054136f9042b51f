#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/context.h"
#include "nodes/media/clip.h"
#include "nodes/types/audio.h"
#include "nodes/types/video.h"

// What libtalkgraph_codecs.so offers; codec() (nodes/types/codec.h) finds it by name. Pictures are 8-bit BGR.

#pragma GCC visibility push(default)
extern "C" {

/// Empty if it cannot be decoded.
void codec_read_picture(const std::string& file, cv::Mat& pixels);
void codec_decode_picture(const std::vector<std::uint8_t>& bytes, cv::Mat& pixels);
/// PNG or JPEG, by its ending. False if it cannot be written.
bool codec_write_picture(const std::string& file, const cv::Mat& pixels);
void codec_encode_png(const cv::Mat& pixels, std::vector<std::uint8_t>& bytes);

/// Draws an SVG on white, `scale` pixels for one of its own. Throws std::runtime_error: not an SVG, without a size, too
/// large.
void codec_draw_svg(const std::string& svg, double scale, cv::Mat& pixels);

// As in nodes/media/ffmpeg.h; absent in a build without FFmpeg.
void codec_ffmpeg_video(const std::string& path, std::shared_ptr<const talkgraph::VideoSource>& video);
void codec_ffmpeg_audio(const std::string& path, talkgraph::Audio& audio);
void codec_ffmpeg_encode(const std::string& path, const talkgraph::Video& video, const talkgraph::Audio* audio,
                         const talkgraph::ClipSettings& settings, const talkgraph::Context& context);
}
#pragma GCC visibility pop
