#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nodes/types/phones.h"
#include "nodes/types/video.h"

namespace talkgraph::annotate {

/// A clip whose frames may be annotated.
struct Clip {
  std::string id;
  std::function<Video()> video;
  std::optional<PhoneTrack> phones;
};

struct Frame {
  std::size_t clip = 0;
  std::int64_t number = 0;  ///< counts from 0
  std::string phone;        ///< empty: not known
};

/// The frames that a person shall annotate, the same for the same clips and seed; fewer of them are the first of more.
/// Where clips have phones: the middle of one of every phone in turn, the most frequent first, drawn at random; else
/// evenly over the clips and their time. Frames that the decoder complained about are passed over. Fewer than `count`
/// are given where there are no more. Throws std::runtime_error if a video cannot be read.
std::vector<Frame> choose_frames(const std::vector<Clip>& clips, int count, std::uint64_t seed);

}  // namespace talkgraph::annotate
