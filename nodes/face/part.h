#pragma once

#include "graph/parameter.h"

namespace talkgraph {

enum class FacePart { lower, whole };
template <>
inline constexpr EnumNames<FacePart, 2> enum_names<FacePart>{{{FacePart::lower, "lower"}, {FacePart::whole, "whole"}}};

}  // namespace talkgraph
