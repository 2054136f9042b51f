#pragma once

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// Which landmarks come with the pictures.
enum class PointScheme { ibug68 };
template <>
inline constexpr EnumNames<PointScheme, 1> enum_names<PointScheme>{{{PointScheme::ibug68, "ibug68"}}};

/// A speaker who comes with the program: sentences spoken by espeak-ng, a face
/// whose articulators follow the phones with coarticulation, and head motion,
/// blinks and noise that do not. Phones, words, transcript and landmarks are
/// exact and the same on every machine; sound and pictures are made when asked
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
