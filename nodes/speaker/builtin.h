#pragma once

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// Which landmarks come with the pictures: the 68 of iBUG; the 56 of them that
/// lie on no eye (jaw, brows, nose, lips), as the source marked its LIPS
/// corpus; or all 68 and the middle of the forehead, 69 as for DEMNOW.
enum class PointScheme { ibug68, lips56, demnow69 };
template <>
inline constexpr EnumNames<PointScheme, 3> enum_names<PointScheme>{
    {{PointScheme::ibug68, "ibug68"}, {PointScheme::lips56, "lips56"}, {PointScheme::demnow69, "demnow69"}}};

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
  PointScheme points = PointScheme::ibug68;

  Stream<Recording> operator()() const;
};
void describe(Description<BuiltinSpeaker>& d);

}  // namespace talkgraph
