#include "nodes/types/context_gp.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "nodes/types/stored_model.h"

namespace talkgraph {

namespace {

bool all_within(const std::vector<std::int64_t>& numbers, Eigen::Index most) {
  return std::all_of(numbers.begin(), numbers.end(), [&](std::int64_t i) { return i >= 0 && i <= most; });
}

void check(const ContextGp& g) {
  const StoredModel stored("soft contexts");
  const Eigen::Index n = g.frames.rows(), d = g.mean.size(), heard = g.audio_mean.size(), m = std::ssize(g.inducing);
  stored.matrix("audio_mean", g.audio_mean, 1, heard);
  stored.matrix("audio_scale", g.audio_scale, 1, heard);
  stored.require(std::isfinite(g.place_time) && g.place_time >= 0, "place_time", "is not a time");
  stored.matrix("map", g.map, heard + std::ssize(g.phones) + (g.place_time > 0 ? 2 : 0), g.map.cols());
  stored.matrix("window", g.window, 1, g.window.size());
  stored.require(g.window.size() % 2 == 1, "window", "has no middle");
  stored.require(all_within(g.lengths, n) && std::accumulate(g.lengths.begin(), g.lengths.end(), std::int64_t{0}) == n,
                 "lengths", "do not sum to the number of frames");
  stored.matrix("frames", g.frames, n, g.map.cols());
  stored.matrix("weights", g.weights, n, d);
  stored.matrix("mean", g.mean, 1, d);
  stored.matrix("signal", g.signal, 1, d);
  stored.require((g.signal.array() >= 0).all(), "signal", "has a value below 0");
  stored.positive("noise", g.noise);
  stored.require(all_within(g.inducing, n - 1), "inducing", "are no frames");
  stored.matrix("certainty", g.certainty, m, m);
}

}  // namespace

void fields(Archive& ar, ContextGp& g) {
  ar("audio_mean", g.audio_mean);
  ar("audio_scale", g.audio_scale);
  ar("phones", g.phones);
  ar("place_time", g.place_time);
  ar("map", g.map);
  ar("window", g.window);
  ar("lengths", g.lengths);
  ar("frames", g.frames);
  ar("weights", g.weights);
  ar("mean", g.mean);
  ar("signal", g.signal);
  ar("noise", g.noise);
  ar("inducing", g.inducing);
  ar("certainty", g.certainty);
  if (ar.loading()) check(g);
}

}  // namespace talkgraph
