#pragma once

#include <vector>

#include "nodes/phones/pocketsphinx.h"
#include "nodes/types/audio.h"

namespace talkgraph {

/// When the phones of a model with frames of 10 ms begin, seconds: in order, the first at 0, none beyond the end.
///
/// A boundary of the model is moved by at most 20 ms to where the spectrum changes most, unless both phones
/// are vowels or glides, which pass into each other, or the sound of a nasal or of a voiced stop is released
/// into one: those stay. A pause of at most 100 ms
/// between a phone and a stop is the closure of the stop and belongs to it.
std::vector<double> phone_starts(const std::vector<FrameSpan>& phones, const Audio& audio);

}  // namespace talkgraph
