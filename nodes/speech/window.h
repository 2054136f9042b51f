#pragma once

#include "graph/description.h"
#include "nodes/types/frames.h"

namespace talkgraph {

enum class WindowShape { hamming, hann, blackman, povey, rectangular };
template <>
inline constexpr EnumNames<WindowShape, 5> enum_names<WindowShape>{{{WindowShape::hamming, "hamming"},
                                                                    {WindowShape::hann, "hann"},
                                                                    {WindowShape::blackman, "blackman"},
                                                                    {WindowShape::povey, "povey"},
                                                                    {WindowShape::rectangular, "rectangular"}}};

enum class WindowSpan { symmetric, periodic, open };
template <>
inline constexpr EnumNames<WindowSpan, 3> enum_names<WindowSpan>{
    {{WindowSpan::symmetric, "symmetric"}, {WindowSpan::periodic, "periodic"}, {WindowSpan::open, "open"}}};

/// Weighs each frame with a window, θ going once round: Hamming 0.54 - 0.46 cos θ, Hann 0.5 - 0.5 cos θ, Blackman
/// 0.42 - 0.5 cos θ + 0.08 cos 2θ, Povey's (Kaldi) Hann to the power 0.85, or none. Of sample n of N, θ is 2πn / (N-1),
/// symmetric; 2πn / N, periodic; 2π(n+1) / (N+1), open: without the zeros at both ends, as MATLAB's hanning is.
/// Thesis §3.2.
struct Window {
  WindowShape shape = WindowShape::hamming;
  WindowSpan span = WindowSpan::symmetric;

  Frames operator()(const Frames& frames) const;

  Eigen::RowVectorXd weights(Eigen::Index samples) const;
};
void describe(Description<Window>& d);
void parameters(Parameters<Window>& p);  // for nodes that weigh frames on the way

}  // namespace talkgraph
