#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// Where the frames of a video come from: a file, a folder, a renderer.
/// Frames are 8-bit BGR, all of one size.
class VideoSource {
 public:
  /// Reads frames in order, once.
  class Reader {
   public:
    virtual ~Reader() = default;
    /// False at the end. Throws std::runtime_error naming the file on damage
    /// that cannot be read past.
    virtual bool next(cv::Mat& frame) = 0;
  };

  virtual ~VideoSource() = default;
  virtual Rational rate() const = 0;
  virtual std::int64_t frames() const = 0;
  virtual cv::Size size() const = 0;
  virtual std::unique_ptr<Reader> open() const = 0;
  /// Says what it is, for messages: a file name.
  virtual std::string name() const = 0;
  /// Changes whenever the pictures do.
  virtual Key key() const = 0;
  /// Frames that the decoder complained about.
  virtual std::vector<std::int64_t> decoding_errors() const { return {}; }
};

/// A lazy handle: nothing is decoded or rendered until it is opened.
struct Video {
  std::shared_ptr<const VideoSource> source;
  std::vector<std::int64_t> damaged;  ///< indices of frames not to be trusted

  bool is_damaged(std::int64_t frame) const;
  /// All frames; for short clips only.
  std::vector<cv::Mat> read_all() const;
};
template <>
inline constexpr PortType port_type<Video>{"Video", 1};
/// Loading gives the frames from memory; saving stores them as PNG; hashing takes the source's key.
void fields(Archive& ar, Video& v);

/// A video of frames in memory.
Video video_from_frames(std::vector<cv::Mat> frames, Rational rate, std::string name = "memory");

/// One picture.
struct Image {
  cv::Mat pixels;  ///< 8-bit BGR
};
template <>
inline constexpr PortType port_type<Image>{"Image", 1};
void fields(Archive& ar, Image& i);

}  // namespace talkgraph
