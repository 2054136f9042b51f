#include "nodes/latent/sequences.h"

#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {

namespace {

void require_finite(const Track& track, const std::string& subject) {
  for (Eigen::Index t = 0; t < track.frames(); ++t)
    if (!track.values.row(t).allFinite())
      throw std::runtime_error(fmt::format("{} has a value that is not finite in frame {}", subject, t));
}

}  // namespace

Sequences measured_runs(const Collected<Track>& tracks) {
  Sequences s;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    if (track.frames() == 0) continue;
    if (s.frames.rows() > 0 && track.dimension() != s.frames.cols())
      throw std::runtime_error(
          fmt::format("track \"{}\" has {} dimensions, those before it {}: train all on the same "
                      "features",
                      tracks.key(i), track.dimension(), s.frames.cols()));
    require_finite(track, "track \"" + tracks.key(i) + "\"");
    bool goes_on = false;
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      const bool lost = track.is_lost(t);
      if (!lost && goes_on) ++s.lengths.back();
      if (!lost && !goes_on) s.lengths.push_back(1);
      goes_on = !lost;
    }
    const Eigen::Index had = s.frames.rows(), lost = static_cast<Eigen::Index>(track.lost.size());
    s.frames.conservativeResize(had + track.frames() - lost, track.dimension());
    Eigen::Index row = had;
    for (Eigen::Index t = 0; t < track.frames(); ++t)
      if (!track.is_lost(t)) s.frames.row(row++) = track.values.row(t);
  }
  if (s.frames.rows() == 0 || s.frames.cols() == 0)
    throw std::runtime_error("the tracks have no measured frame to train on");
  return s;
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
