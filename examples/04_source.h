// 4. A source: one call gives a stream of items, each with a key. Items are made when they are asked for, so that a
// stream may be longer than memory.
#pragma once

#include <numbers>

#include "graph/description.h"
#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace mine {

using talkgraph::Audio, talkgraph::Track, talkgraph::Description, talkgraph::Random;

/// Recordings of a buzzing voice whose jaw moves at 25 frames per second: 0 is closed, 1 open; the further it is open,
/// the louder the voice.
struct Babble {
  // A returned struct gives several outputs.
  struct Recording {
    Audio sound;
    Track jaw;
  };
  int count = 8;
  double seconds = 2;

  // Random numbers come from talkgraph's generator: the graph's seed gives the same ones on every machine. The stream
  // is read after this call has ended, so it keeps a copy.
  talkgraph::Stream<Recording> operator()(Random& random) const {
    const auto next = [*this, random, made = 0]() mutable -> std::optional<talkgraph::Item<Recording>> {
      if (made == count) return {};
      return talkgraph::Item<Recording>{"babble" + std::to_string(made++), record(random)};
    };
    return {next, count};
  }

 private:
  Recording record(Random& random) const {
    std::vector<double> opening;  // of syllables, four a second
    for (int s = 0; s < 4 * seconds + 1; ++s) opening.push_back(random.uniform(0.1, 1));
    const auto jaw_at = [&](double time) {
      const double swing = std::sin(4 * std::numbers::pi * time);
      return opening[static_cast<std::size_t>(4 * time)] * swing * swing;
    };
    Recording out{{Eigen::VectorXd(static_cast<Eigen::Index>(seconds * 16000)), 16000},
                  {Eigen::MatrixXd(static_cast<Eigen::Index>(seconds * 25), 1), 25, 0.02, {"jaw"}}};
    for (Eigen::Index n = 0; n < out.sound.samples.size(); ++n) {
      const double time = double(n) / 16000;
      const double level = 40 * jaw_at(time) - 60;  // dB
      out.sound.samples[n] = std::pow(10, level / 20) * std::sin(2 * std::numbers::pi * 200 * time);
    }
    for (Eigen::Index t = 0; t < out.jaw.frames(); ++t) out.jaw.values(t) = jaw_at(out.jaw.time(t));
    return out;
  }
};
inline void describe(Description<Babble>& d) {
  d.type("mine.babble").summary("recordings of a buzzing voice and its jaw");
  d.output("sound", &Babble::Recording::sound, "16 kHz").output("jaw", &Babble::Recording::jaw, "25 frames per second");
  d.param("count", &Babble::count).within(1, 1000).doc("recordings made");
  d.param("seconds", &Babble::seconds).within(0.1, 60).unit("s").doc("length of each");
}

}  // namespace mine
