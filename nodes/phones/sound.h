#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nodes/phones/pocketsphinx.h"
#include "nodes/types/audio.h"
#include "nodes/types/phones.h"

namespace talkgraph {

/// The sound as PocketSphinx takes it: 16 kHz, 16 bits, resampled by soxr, with the noise of a quiet
/// room (66 dB below the loudest sample, always the same).
std::vector<std::int16_t> sphinx_samples(const Audio& audio);

/// Whether there is nothing to be found in the sound: shorter than 50 ms, or
/// never beyond 3 steps of a 16-bit recording.
bool is_blank(const Audio& audio);

/// One "sil" of the length of the sound; nothing for no sound.
PhoneTrack all_silence(const Audio& audio);

/// A phone of the model ("AH", "SIL", "+NSN+") as PhoneTrack has it; fillers are "sil".
std::string cmu_label(const std::string& label);

/// Phones with times, from the model's labels and the starts of each; adjoining silences
/// become one, what has no length vanishes; the last ends with the sound.
PhoneTrack phone_track(const std::vector<FrameSpan>& phones, const std::vector<double>& starts, double seconds);

}  // namespace talkgraph
