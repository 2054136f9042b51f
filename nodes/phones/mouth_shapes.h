#pragma once

#include <vector>

#include "nodes/types/phones.h"

namespace talkgraph {

/// Mouth shapes of phones as animators draw them (Preston Blair's set, with the
/// names of Rhubarb Lip Sync): "A" closed, "B" clenched teeth, "C" open, "D" wide
/// open, "E" rounded, "F" puckered, "G" teeth on lip, "H" tongue raised, "X"
/// idle.
///
/// A diphthong takes its first shape for 60 % of its time. A stop closes before its
/// burst, for half of the phone before it, 40 to 120 ms. Where a phone leaves
/// the shape open, the one nearest to the shape before is taken. A pause
/// shorter than 250 ms is "B", a longer one "X"; shapes shorter than 30 ms are
/// left out. Times are whole centiseconds; shapes cover the track without gaps.
std::vector<Interval> mouth_shapes(const PhoneTrack& phones);

}  // namespace talkgraph
