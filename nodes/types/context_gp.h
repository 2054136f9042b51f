#pragma once

#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A Gaussian process from sound and phones around a frame to visual parameters, with contexts that are soft. A frame
/// is described by its sound, by how much of it each phone takes and, if wanted, by its place in the recording; the
/// kernel of two frames is
///   k(t, t') = exp(−Σ_l window_l |f_{t+l} − f'_{t'+l}|²),  f = [(audio − audio_mean) audio_scale, phones, place] map,
/// frames beyond an end of an utterance being that end's. A place is exp(−(time since the recording begins) /
/// place_time) and exp(−(time until speech ends) / place_time).
struct ContextGp {
  Eigen::RowVectorXd audio_mean;   ///< of the audio dimensions
  Eigen::RowVectorXd audio_scale;  ///< 1 / deviation; 0 for a constant one
  std::vector<std::string> phones;
  double place_time = 0;               ///< seconds; 0: places are not compared
  Eigen::MatrixXd map;                 ///< (audio + phones + 2 if places are compared) × C
  Eigen::RowVectorXd window;           ///< 2n + 1 weights of the neighbours
  std::vector<std::int64_t> lengths;   ///< of the training utterances, which sum to N
  Eigen::MatrixXd frames;              ///< f of the training utterances, N × C
  Eigen::MatrixXd weights;             ///< N × D, 0 where nothing was learnt
  Eigen::RowVectorXd mean;             ///< of the visual parameters, 1 × D
  Eigen::RowVectorXd signal;           ///< variance of what the process explains, 1 × D
  double noise = 0;                    ///< variance of the noise, of the signal's
  std::vector<std::int64_t> inducing;  ///< M rows of `frames`
  /// M × M: what is known at a frame whose kernel with the inducing ones is k, a share k `certainty` kᵀ of the signal's
  /// variance.
  Eigen::MatrixXd certainty;
};
template <>
inline constexpr PortType port_type<ContextGp>{"ContextGp", 4};
void fields(Archive& ar, ContextGp& g);

}  // namespace talkgraph
