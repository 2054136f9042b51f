#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/segments.h"
#include "nodes/types/ssgpdm.h"
#include "nodes/types/track.h"

namespace talkgraph {

enum class LatentSearch {
  optimise,  ///< Algorithm 7: point optimisation of one-frame segments, sequence optimisation of others
  predict,   ///< Algorithm 8: the first frame of a segment is optimised, the others follow from the dynamics
  initial    ///< the start values as they are
};
template <>
inline constexpr EnumNames<LatentSearch, 3> enum_names<LatentSearch>{
    {{LatentSearch::optimise, "optimise"}, {LatentSearch::predict, "predict"}, {LatentSearch::initial, "initial"}}};

enum class LatentInitial {
  frame,            ///< each frame the latent point of its nearest training frame
  window,           ///< the latent path of the nearest training window, at its best offset or stretched
  back_constraint,  ///< that of the state
  hmm               ///< the likeliest path through training points
};
template <>
inline constexpr EnumNames<LatentInitial, 4> enum_names<LatentInitial>{
    {{LatentInitial::frame, "frame"},
     {LatentInitial::window, "window"},
     {LatentInitial::back_constraint, "back_constraint"},
     {LatentInitial::hmm, "hmm"}}};

/// Visual features of new speech by a switching SGPDM, segment after segment
/// (docs/method.md §5, Algorithms 7 and 8): start values from the state's nearest
/// training audio, optimisation of the latent points, mean of the visual process
/// (Eqn 4.76). A segment whose label has no state is answered by state_for(). A
/// segment may be shorter or longer than the state's training windows.
///
/// Audio and segments that differ by at most 2 frames are used on their common
/// beginning. Throws std::runtime_error if they differ by more, if segments leave
/// gaps or overlap, on another audio dimension than the model's, on values that are
/// not finite, if a state lacks the back-constraint to start from, or where the likelihood of a segment is not finite.
/// No frames give no frames.
struct SynthesiseSsgpdm {
  struct Out {
    Track visual;         ///< T × D_Z, rate and start of the audio
    Track deviation;      ///< predictive standard deviation given the latent points, T × D_Z
    Track latents;        ///< those points, T × the largest d; a state of fewer dimensions leaves the last at 0
    SegmentTrack states;  ///< the segments with the labels of the states that answered
  };
  LatentSearch method = LatentSearch::optimise;
  LatentInitial initial = LatentInitial::window;
  int hmm_states = 500;
  double smoothness = 1;
  bool dynamics = true;
  int iterations = 15;

  Out operator()(const Ssgpdm& model, const Track& audio, const SegmentTrack& segments, Context& context) const;
};
void describe(Description<SynthesiseSsgpdm>& d);

/// What a search finds for one segment.
struct SegmentLatents {
  Eigen::MatrixXd points;  ///< T × d
  bool evaluated = true;   ///< their likelihood could be
  bool converged = true;   ///< every optimisation ended before its limit
};
/// `audio` is T × D_Y, scaled as the state's; `before` the last visual frame before the segment, scaled likewise, if
/// there is one.
SegmentLatents segment_latents(const SynthesiseSsgpdm& search, const Sgpdm& state, const Eigen::MatrixXd& audio,
                               const std::optional<Eigen::RowVectorXd>& before);

}  // namespace talkgraph
