#pragma once

#include <vector>

#include "graph/description.h"

namespace talkgraph {

enum class Correction { none, holm, benjamini_hochberg };
template <>
inline constexpr EnumNames<Correction, 3> enum_names<Correction>{
    {{Correction::none, "none"}, {Correction::holm, "holm"}, {Correction::benjamini_hochberg, "benjamini_hochberg"}}};

/// p-values of many tests, made such that comparing each with α bounds the chance of any false finding (holm: Holm
/// 1979) or the expected share of false findings (benjamini_hochberg: Benjamini & Hochberg 1995) by α. NaN is no test:
/// it stays, and is not counted.
std::vector<double> corrected(const std::vector<double>& p, Correction correction);

}  // namespace talkgraph
