#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/speaker/drawn_frames.h"
#include "nodes/speaker/renderer.h"
#include "nodes/types/video.h"

namespace talkgraph::face {

/// The painted face that all recordings of a speaker share, painted when the first frame is drawn, and the frames of
/// them that were drawn last.
class Portrait {
 public:
  Portrait(int height, std::uint64_t seed) : height_(height), seed_(seed) {}
  int height() const { return height_; }
  const Renderer& renderer() const;
  DrawnFrames& drawn() const { return drawn_; }

 private:
  int height_;
  std::uint64_t seed_;
  mutable std::once_flag painted_;
  mutable std::optional<Renderer> renderer_;
  mutable DrawnFrames drawn_{std::size_t{128} << 20U};
};

/// Moments of a face as a video, drawn frame by frame when read. `key` is the
/// video's content key.
Video talking_video(std::shared_ptr<const Portrait> portrait, std::vector<Moment> moments, Rational rate,
                    std::string name, const Key& key, std::uint64_t noise_seed);

}  // namespace talkgraph::face
