#pragma once

#include "graph/description.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Two videos beside each other, each under a label (none if both are empty), at the height of the
/// taller and the length of the shorter; sides are even. Rendered when read.
/// Throws std::runtime_error if their rates differ.
struct SideBySide {
  std::string left_label = "recorded";
  std::string right_label = "synthesised";

  Video operator()(const Video& left, const Video& right) const;
};
void describe(Description<SideBySide>& d);

}  // namespace talkgraph
