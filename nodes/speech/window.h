#pragma once

#include "graph/description.h"
#include "nodes/types/frames.h"

namespace talkgraph {

enum class WindowShape { hamming, hann, rectangular };
template <>
inline constexpr EnumNames<WindowShape, 3> enum_names<WindowShape>{
    {{WindowShape::hamming, "hamming"}, {WindowShape::hann, "hann"}, {WindowShape::rectangular, "rectangular"}}};

/// Weighs each frame with a symmetric window: Hamming 0.54 - 0.46 cos(2πn / (N-1)),
/// Hann 0.5 - 0.5 cos, or none. Thesis §3.2.
struct Window {
  WindowShape shape = WindowShape::hamming;

  Frames operator()(const Frames& frames) const;
};
void describe(Description<Window>& d);

}  // namespace talkgraph
