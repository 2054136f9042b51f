#pragma once

#include "graph/description.h"
#include "nodes/types/face_track.h"
#include "nodes/types/independent_components.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What a component is called style by.
enum class StyleSign { sound, speed, pose };
template <>
inline constexpr EnumNames<StyleSign, 3> enum_names<StyleSign>{
    {{StyleSign::sound, "sound"}, {StyleSign::speed, "speed"}, {StyleSign::pose, "pose"}}};

/// Ranks independent components from what is most likely style to what is
/// speech, for a person or normalise.remove_style to choose from:
///   variance  share of all components'
///   sound     share of it that the sound explains, linearly from the features of `context` frames on both sides,
///             on frames not learnt from
///   speed     root mean square step from frame to frame, in deviations
///   pose      share that the head's place, size and angle in the picture explain likewise; NaN without face tracks
///   style     0 to 1 by `by`: 1 − sound / the largest sound, 1 − speed / the largest, or pose / the largest
/// Tracks are matched by key. Throws std::runtime_error where evaluate.explained does, if `by` is pose and no face
/// tracks are given, and if `by` is sound and the sound explains less than 0.05 of every component.
struct RankStyle {
  StyleSign by = StyleSign::sound;
  int context = 3;

  Table operator()(const IndependentComponents& components, const Collected<Track>& tracks,
                   const Collected<Track>& sound, const Collected<FaceTrack>& faces) const;
};
void describe(Description<RankStyle>& d);

/// Takes style off a track: u = A⁻¹ (c − mean), style components set to zero,
/// A u (thesis §3.4.1). Style are the components named in `style` (from 1),
/// and, if a ranking is given and none is named, those whose "style" there is
/// at least `above`. Throws std::runtime_error on numbers that no component
/// has, a ranking of other components, values that are not finite, and if the
/// ranking calls all components style.
struct RemoveStyle {
  std::vector<int> style;
  double above = 0.9;

  struct Out {
    Track normalised;  ///< T × D
    Track style;  ///< T × D, what was taken off: the training mean, the style of each frame, and what no component has
  };
  Out operator()(const IndependentComponents& components, const Track& track, const Table* ranking) const;
};
void describe(Description<RemoveStyle>& d);

}  // namespace talkgraph
