#pragma once

#include <string>

#include "graph/parameter.h"
#include "nodes/types/audio.h"

namespace talkgraph {

/// Reads sound: WAV (with extensible headers, RF64, W64), AIFF, AU, CAF, FLAC, OGG, MP3 and what else
/// libsndfile knows, otherwise the sound track of whatever FFmpeg can read, aligned to the first picture
/// of a video. Several channels become their mean.
///
/// A WAV whose header leaves the length open (2³²−1 or 2³¹−2¹², as programs write that
/// stream) is read to the end of the file. Throws std::runtime_error naming the file
/// where it is missing, empty, not sound, without one sample, shorter than its header
/// promises, holds a sample that is NaN or infinite, or has a rate outside 1 kHz to 1 MHz.
/// Damage that a format cannot tell from sound (MP3 has no checksum, and no length) gives the sound
/// that is left.
Audio read_audio(const std::string& path);

enum class WavFormat { pcm16, pcm24, float32 };
template <>
inline constexpr EnumNames<WavFormat, 3> enum_names<WavFormat>{
    {{WavFormat::pcm16, "pcm16"}, {WavFormat::pcm24, "pcm24"}, {WavFormat::float32, "float32"}}};

/// Writes a mono WAV file; integer formats clip at full scale. Throws
/// std::runtime_error if it cannot be written, std::invalid_argument for a rate
/// that is not a whole number or samples that are not finite.
void write_audio(const std::string& path, const Audio& audio, WavFormat format = WavFormat::pcm16);

/// Converts the rate by libsoxr (HQ) with double precision; the length becomes
/// round(n · rate / audio.rate). No sound gives no sound.
Audio resampled(const Audio& audio, double rate);

}  // namespace talkgraph
