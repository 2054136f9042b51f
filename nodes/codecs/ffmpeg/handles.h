#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <memory>
#include <string>

namespace talkgraph {

/// Owners of what FFmpeg's libraries allocate.
struct FreeFfmpeg {
  void operator()(AVCodecContext* c) const { avcodec_free_context(&c); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFrame* f) const { av_frame_free(&f); }
  void operator()(SwsContext* s) const { sws_freeContext(s); }
};
using CodecHandle = std::unique_ptr<AVCodecContext, FreeFfmpeg>;
using PacketHandle = std::unique_ptr<AVPacket, FreeFfmpeg>;
using FrameHandle = std::unique_ptr<AVFrame, FreeFfmpeg>;
using ScalerHandle = std::unique_ptr<SwsContext, FreeFfmpeg>;

inline std::string ffmpeg_error(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

/// HD pictures are BT.709, smaller ones BT.601, unless they say otherwise.
inline AVColorSpace default_colours(int height) { return height >= 720 ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M; }

}  // namespace talkgraph
