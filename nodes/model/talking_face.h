#pragma once

#include <optional>
#include <string>

#include "nodes/types/appearance_model.h"
#include "nodes/types/base_clip.h"
#include "nodes/types/context_gp.h"
#include "nodes/types/mouths.h"
#include "nodes/types/ssgpdm.h"
#include "nodes/types/track.h"
#include "nodes/types/vlmm.h"

namespace talkgraph {

/// All that is needed to let new speech drive a learnt face, in one file.
struct TalkingFace {
  AppearanceModel face;
  BaseClip base;  ///< pictures that speech is drawn upon
  Vlmm contexts;
  std::optional<Ssgpdm> states;      ///< the switching model, or
  std::optional<ContextGp> process;  ///< the process of soft contexts: what moves the face
  Track mean;                        ///< 1 × D: mean visual parameters of the training clips
  Mouths mouths;                     ///< real ones for the face to show; may be none
  std::string speak;                 ///< the graph that speaks with these, resolved, as JSON
};
template <>
inline constexpr PortType port_type<TalkingFace>{"TalkingFace", 3};
void fields(Archive& ar, TalkingFace& f);

}  // namespace talkgraph
