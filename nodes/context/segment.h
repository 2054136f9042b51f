#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/segments.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// What a state of the switching model stands for.
enum class StateKind {
  contexts,  ///< a context label of the Markov model
  phones,    ///< a phone; its windows are the phone's runs
  one        ///< whole utterances: one SGPDM that does not switch
};
/// The label of the state where there is one.
inline constexpr const char* one_state = "utterance";
template <>
inline constexpr EnumNames<StateKind, 3> enum_names<StateKind>{
    {{StateKind::contexts, "contexts"}, {StateKind::phones, "phones"}, {StateKind::one, "one"}}};

/// Cuts a stream of context labels into segments that do not overlap and cover
/// every frame (docs/method.md §5, thesis Algorithm 4). From the last frame backwards,
/// the context there becomes its longest trainable suffix, which takes as many
/// frames as it has phones (runs of frames, with a model of runs). At the first
/// frame a label that is too long loses its oldest phones. A phone unknown to
/// the model becomes the commonest of its viseme. With phones as states,
/// segments are the runs of each phone; with one state, the utterance is one segment.
/// With `merge` neighbours of one label become one segment, as where the source compares labels only.
struct ContextSegment {
  StateKind states = StateKind::contexts;
  bool merge = false;

  SegmentTrack operator()(const Vlmm& vlmm, const FrameLabels& contexts) const;
};
void describe(Description<ContextSegment>& d);

}  // namespace talkgraph
