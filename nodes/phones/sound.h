#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nodes/phones/pocketsphinx.h"
#include "nodes/types/audio.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// The sound as PocketSphinx takes it: 16 kHz, 16 bits, resampled by soxr.
std::vector<std::int16_t> sphinx_samples(const Audio& audio);

/// Whether there is nothing to be found in the sound: shorter than 50 ms, or
/// never beyond 3 steps of a 16-bit recording.
bool is_blank(const Audio& audio);

/// PocketSphinx counts the frames of an utterance in 16 bits and ends the
/// process beyond that; seconds.
inline constexpr double kLongest = 300;

/// One "sil" of the length of the sound; nothing for no sound.
PhoneTrack all_silence(const Audio& audio);

/// Phones with times, from the model's labels: fillers become "sil" and
/// adjoining silences one; the first starts at 0, the last ends with the sound.
PhoneTrack phone_track(const std::vector<FrameSpan>& phones, double seconds);

}  // namespace talkgraph
