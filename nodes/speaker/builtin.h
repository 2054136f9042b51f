#pragma once

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// The point scheme of the landmarks that come with the pictures (docs/schemes.md); the source marked 56
/// points for LIPS and 69 for DEMNOW.
enum class SpeakerPoints { ibug68, face56, ibug69 };
template <>
inline constexpr EnumNames<SpeakerPoints, 3> enum_names<SpeakerPoints>{
    {{SpeakerPoints::ibug68, "ibug68"}, {SpeakerPoints::face56, "face56"}, {SpeakerPoints::ibug69, "ibug69"}}};

/// A speaker who comes with the program: sentences spoken by espeak-ng, a face
/// whose articulators follow the phones with coarticulation, and head motion,
/// blinks and noise that do not. Phones, words, transcript and landmarks are
/// exact and the same on every machine, and so is the visual track: where the
/// articulators and the head truly were, by names; sound and pictures are made when asked
/// for, equally long. Recordings are keyed "s001", "s002" ...; the last
/// `held_out` are the test split, the `validation` before them the validation
/// split. Throws std::invalid_argument if these leave nothing to train on.
struct BuiltinSpeaker {
  std::int64_t sentences = 60;
  std::int64_t held_out = 10;
  std::int64_t validation = 0;
  Rational fps{25};
  std::int64_t height = 288;  ///< of the pictures, pixels; even
  double sample_rate = 22050;
  std::int64_t seed = 1;
  SpeakerPoints points = SpeakerPoints::ibug68;

  Stream<Recording> operator()() const;
};
void describe(Description<BuiltinSpeaker>& d);

/// What is wrong with parameters that are right one by one; empty if nothing is.
std::string complaint(const BuiltinSpeaker& node);

}  // namespace talkgraph
