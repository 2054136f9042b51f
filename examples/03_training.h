// 3. Training: a node that wants a whole stream takes Collected<T> and gives one value, a model. Wired to a node that
// runs for every item, the model is given to each call.
#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace mine {

using talkgraph::Collected, talkgraph::Track, talkgraph::Description;

// The model is a type of our own. Two things make it a port type: fields(), which names each member once, for saving,
// loading and telling values apart, ...

/// How far a jaw opens: offset + gain * loudness.
struct JawModel {
  double offset = 0, gain = 0;
};
inline void fields(talkgraph::Archive& ar, JawModel& model) {
  ar("offset", model.offset);
  ar("gain", model.gain);
}

}  // namespace mine

// ... and a name that no other type has, with a version to raise when the members or their meaning change.
template <>
inline constexpr talkgraph::PortType talkgraph::port_type<mine::JawModel>{"JawModel", 1};

namespace mine {

/// Least squares over all frames of all recordings that have both.
struct LearnJaw {
  JawModel operator()(const Collected<Track>& loudness, const Collected<Track>& jaw) const {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < loudness.size(); ++i) {
      const Track* opening = jaw.find(loudness.key(i));  // items are told by their keys
      if (!opening) continue;
      const auto frames = std::min(loudness[i].frames(), opening->frames());
      const auto a = loudness[i].values.col(0).head(frames), b = opening->values.col(0).head(frames);
      n += double(frames), x += a.sum(), y += b.sum(), xx += a.squaredNorm(), xy += a.dot(b);
    }
    // An exception ends the run; talkgraph adds node, item and place. Say what is wrong and what to do.
    if (n * xx - x * x <= 0) throw std::runtime_error("the loudness never changes: is there speech in the recordings?");
    const double gain = (n * xy - x * y) / (n * xx - x * x);
    return {(y - gain * x) / n, gain};
  }
};
// Results of training are worth keeping: stored() lets later runs find them. Raise version() when the code gives other
// results, so that nobody finds the old ones.
inline void describe(Description<LearnJaw>& d) {
  d.type("mine.learn_jaw").version(1).summary("learns how loudness opens the jaw").stored();
  d.input("loudness", "T x 1 each").input("jaw", "T x 1 each, at the same rate").output("model", "the line");
}

/// Opens a jaw with loudness.
struct MoveJaw {
  Track operator()(const Track& loudness, const JawModel& model) const {
    Track jaw = loudness;
    jaw.values = (model.offset + model.gain * loudness.values.array()).matrix();
    jaw.names = {"jaw"};
    return jaw;
  }
};
inline void describe(Description<MoveJaw>& d) {
  d.type("mine.move_jaw").summary("opens a jaw with loudness");
  d.input("loudness", "T x 1").input("model", "of mine.learn_jaw").output("jaw", "T x 1");
}

}  // namespace mine
