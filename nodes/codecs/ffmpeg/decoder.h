#pragma once

#include "nodes/codecs/ffmpeg/handles.h"

namespace talkgraph {

/// Decodes the best stream of one kind of a file on one thread, frame by frame
/// in presentation order. Throws std::runtime_error that names the file.
class Decoder {
 public:
  Decoder(const std::string& path, AVMediaType kind);

  AVFormatContext& file() const { return *file_; }
  AVStream& stream() const { return *stream_; }

  /// The next frame, valid until the next call, or null at the end.
  const AVFrame* next();
  /// Whether the decoder complained about the frame last given.
  bool damaged() const;
  /// Presentation time of the frame last given, seconds; NaN if unknown.
  double time() const;

 private:
  struct CloseFile {
    void operator()(AVFormatContext* c) const { avformat_close_input(&c); }
  };

  void open_file(AVMediaType kind);
  void open_codec(const AVCodec* codec);
  /// Hands one more packet of the stream to the codec; at the end of the file, the end.
  void feed();

  std::string path_;
  std::unique_ptr<AVFormatContext, CloseFile> file_;
  AVStream* stream_ = nullptr;
  CodecHandle codec_;
  PacketHandle packet_;
  FrameHandle frame_;
  bool broken_packet_ = false;
  bool damaged_ = false;
};

}  // namespace talkgraph
