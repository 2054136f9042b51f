#pragma once

#include "graph/parameter.h"

namespace talkgraph {

enum class ClipFormat { mp4, webm };
template <>
inline constexpr EnumNames<ClipFormat, 2> enum_names<ClipFormat>{
    {{ClipFormat::mp4, "mp4"}, {ClipFormat::webm, "webm"}}};

/// How a clip is written.
struct ClipSettings {
  ClipFormat format = ClipFormat::mp4;
  int crf = 18;  ///< constant rate factor: lower is better and larger
};

}  // namespace talkgraph
