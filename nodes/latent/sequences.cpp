#include "nodes/latent/sequences.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

void require_finite(const Track& track, const std::string& subject) {
  for (Eigen::Index t = 0; t < track.frames(); ++t)
    if (!track.values.row(t).allFinite())
      throw std::runtime_error(fmt::format("{} has a value that is not finite in frame {}", subject, t));
}

}  // namespace

Sequences measured_runs(const Collected<Track>& tracks) {
  Eigen::Index frames = 0, dimension = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    if (track.frames() == 0) continue;
    if (frames > 0 && track.dimension() != dimension)
      throw std::runtime_error(
          fmt::format("track \"{}\" has {} dimensions, those before it {}: train all on the same "
                      "features",
                      tracks.key(i), track.dimension(), dimension));
    require_finite(track, "track \"" + tracks.key(i) + "\"");
    dimension = track.dimension();
    frames += track.frames() - std::ssize(track.lost);
  }
  if (frames == 0 || dimension == 0) throw std::runtime_error("the tracks have no measured frame to train on");
  Sequences s{Eigen::MatrixXd(frames, dimension), {}};
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    bool goes_on = false;
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      const bool lost = track.is_lost(t);
      if (!lost && goes_on) ++s.lengths.back();
      if (!lost && !goes_on) s.lengths.push_back(1);
      if (!lost) s.frames.row(row++) = track.values.row(t);
      goes_on = !lost;
    }
  }
  return s;
}

PairedFrames paired_frames(const Collected<Track>& audio, const Collected<Track>& visual) {
  Collected<Track> heard, seen;
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const Track* other = visual.find(audio.key(i));
    if (!other) continue;
    Track a = audio[i], v = *other;
    const Eigen::Index frames = common_frames(audio.key(i), a.frames(), "audio frames", v.frames(), "visual frames");
    a.values.conservativeResize(frames, Eigen::NoChange);
    v.values.conservativeResize(frames, Eigen::NoChange);
    std::vector<std::int64_t> lost;
    for (Eigen::Index t = 0; t < frames; ++t)
      if (a.is_lost(t) || v.is_lost(t)) lost.push_back(t);
    a.lost = v.lost = lost;
    heard.add(audio.key(i), std::move(a));
    seen.add(audio.key(i), std::move(v));
  }
  return {measured_runs(heard).frames, measured_runs(seen).frames};
}

Steps steps_of(const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lengths) {
  const Eigen::Index count = frames.rows() - static_cast<Eigen::Index>(lengths.size());
  Steps steps{{count, frames.cols()}, {count, frames.cols()}};
  Eigen::Index row = 0, at = 0;
  for (const auto length : lengths) {
    steps.from.middleRows(at, length - 1) = frames.middleRows(row, length - 1);
    steps.to.middleRows(at, length - 1) = frames.middleRows(row + 1, length - 1);
    row += length;
    at += length - 1;
  }
  return steps;
}

void require_frames_of(const Track& track, Eigen::Index dimension, const char* model) {
  if (track.dimension() != dimension)
    throw std::runtime_error(
        fmt::format("the track has {} dimensions, {} {}: give it the features that the model was trained on",
                    track.dimension(), model, dimension));
  require_finite(track, "the track");
}

}  // namespace talkgraph
