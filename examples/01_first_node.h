// 1. A first node: how loud is a sound, frame by frame?
//
// A node is a struct with one call operator. What the operator takes are the node's inputs, what it returns is its
// output. It is const and knows nothing of graphs, files or threads: it can be called from anywhere, many times at
// once.
#pragma once

#include "graph/description.h"
#include "nodes/types/audio.h"  // the types that flow between nodes are in nodes/types/
#include "nodes/types/track.h"

namespace mine {

using talkgraph::Audio, talkgraph::Track, talkgraph::Description;

/// Level of each hundredth of a second, dB of full scale (T x 1); silence has -120.
struct Loudness {
  Track operator()(const Audio& audio) const {
    const auto length = static_cast<Eigen::Index>(audio.rate / 100);
    if (length == 0) throw std::runtime_error("a sample rate below 100 has no loudness a hundredth of a second");
    Track track{Eigen::MatrixXd(audio.samples.size() / length, 1), 100, 0.005, {"level"}};
    for (Eigen::Index t = 0; t < track.frames(); ++t)
      track.values(t) = 10 * std::log10(audio.samples.segment(t * length, length).squaredNorm() / length + 1e-12);
    return track;
  }
};

// The description is what a graph needs to know: the type's name, a line for people, and for each input and output, in
// the order of the call operator, a name and what it is.
inline void describe(Description<Loudness>& d) {
  d.type("mine.loudness").summary("level of each hundredth of a second, dB");
  d.input("audio", "one channel").output("level", "T x 1, dB of full scale");
}

}  // namespace mine
